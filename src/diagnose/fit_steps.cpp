#include "diagnose/fit_steps.h"

#include <algorithm>

#include "diagnose/constants.h"
#include "fit/log_data.h"
#include "simulate/together.h"

namespace servodx {

FitSteps::FitSteps(const HypothesisSettings& settings, std::size_t faults)
    : settings_(settings),
      whole_(settings.iterations + around +
             static_cast<double>(faults) *
                 (screening + diagnose_constants::starts_kept * approach + settings.iterations + again)) {}

void FitSteps::done(double steps, long simulations) {
  const double so_far = done_.fetch_add(steps) + steps;
  const long all = simulated_.fetch_add(simulations) + simulations;
  if (settings_.progress) settings_.progress(std::min(1.0, so_far / whole_), all);
}

void each_fit(std::size_t count, const HypothesisData& data, const std::function<void(std::size_t)>& task) {
  std::size_t samples = 0;
  for (const LogData* log : data.logs) samples += log->scenario.time.size();
  fits_together(static_cast<int>(count), samples, data.settings.threads,
                [&](int i) { task(static_cast<std::size_t>(i)); });
}

}  // namespace servodx
