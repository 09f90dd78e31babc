// The analogue low-pass of a measurement chain, as a simulated signal has to pass it before it is set beside what the
// recorder saw (GA paper: a low-pass between the rig and the data acquisition).
//
// Butterworth of order 1 to 8, forward in time, exact for a signal that is linear between its stamps whatever their
// spacing; begins at rest on the first sample. Partial fractions of the pole pairs, each a state of its own (Oppenheim
// & Schafer, Discrete-Time Signal Processing, sec. 7.1). Limits: what lies above half the sampling rate in the valve is
// not in the samples, and so not filtered; the aliases that the filter is there against are left out.
#pragma once
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace servodx {

inline constexpr int highest_low_pass_order = 8;

class LowPass {
 public:
  // `cutoff` [Hz] where 3 dB are lost. Throws std::invalid_argument for a cutoff or an order out of range.
  LowPass(std::span<const double> time, double cutoff, int order);
  // In place; as many samples as stamps, none missing.
  void operator()(std::span<double> x) const;
  void cut(std::size_t from, std::size_t to);                                         // to the stamps [from, to)
  LowPass at(std::span<const double> time) const { return {time, cutoff_, order_}; }  // the same, at other stamps

 private:
  struct Step {
    std::complex<double> keep, level, slope;  // of the state, of the last sample, and of the way to the next
  };
  struct Mode {
    std::complex<double> at_rest;  // state per level
    std::complex<double> weight;   // of the state in the output; the conjugate's counted with it
    std::vector<Step> steps;       // from each sample to the next; of even stamps one
  };
  double cutoff_ = 0;  // [Hz]
  int order_ = 1;
  std::vector<Mode> modes_;
  bool even_ = false;
};

}  // namespace servodx
