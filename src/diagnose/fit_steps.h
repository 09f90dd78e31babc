// The fits about a log side by side, and how far all of them are.
#pragma once
#include <atomic>
#include <cstddef>
#include <functional>

#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"

namespace servodx {

// Progress, counted in steps of least squares: a screening is about one, and few begin again. Told from any thread.
class FitSteps {
 public:
  static constexpr double screening = 1, approach = 1, again = 1;  // a fault
  static constexpr double around = 2;                              // all starts of health but the first

  FitSteps(const HypothesisSettings& settings, std::size_t faults);
  void done(double steps, long simulations);

 private:
  const HypothesisSettings& settings_;
  double whole_;
  std::atomic<double> done_ = 0;
  std::atomic<long> simulated_ = 0;
};

// task(0) to task(count - 1), over the settings' threads; each works on a fit of its own.
void each_fit(std::size_t count, const HypothesisData& data, const std::function<void(std::size_t)>& task);

}  // namespace servodx
