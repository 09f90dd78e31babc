// Linear filters to be applied to the measurement and to its simulation alike, so that what they do to the difference
// is what they would do to it alone: filter(y) - filter(m) = filter(y - m).
//
// Each output is a linear function of the samples, with weights that depend on the time stamps and on which samples are
// missing (NaN), never on the values. The identity above therefore holds where both have the same stamps and the same
// samples missing: give the simulation the measurement's NaN first. A missing sample stays missing.
// Sources: the moving average and the mains notch of the GA fault-diagnosis paper; the high-pass removes drift.
#pragma once
#include <span>
#include <vector>

namespace servodx {

// Mean of the samples present in an odd window of samples, centred; zero phase. The window counts samples, not seconds:
// it means a fixed duration only where the stamps are even. At the ends it shrinks to stay centred, so a constant
// and (no samples missing, even stamps) a ramp pass unchanged. Throws std::invalid_argument for an even or non-positive
// window.
std::vector<double> moving_average(std::span<const double> x, int window);

// Takes out a line at `frequency`: at each stamp a constant plus a sinusoid is fitted by least squares with weights
// exp(-2 pi half_width |t - t_k|), and the sinusoid is subtracted. Zero phase. On any stamps, even or not, with gaps or
// missing samples, a pure line of that frequency leaves nothing and a constant passes unchanged. Elsewhere the
// gain is close to d^2 / (1 + d^2), d = (f - frequency) / half_width: one half at half_width, above 0.99 beyond ten of
// them. Narrower in frequency is longer in time: a step is rung on over about 1 / (2 pi half_width) before and after.
// Within that time of the record's ends the window is one-sided and the notch wider. Needs a record of some cycles. A
// line above half the sampling rate is removed by its alias. half_width [Hz] must be positive.
std::vector<double> notch(std::span<const double> time, std::span<const double> x, double frequency, double half_width);

// First-order high-pass with corner `cutoff` [Hz], forward in time, exact for a signal that is linear between its
// stamps whatever their spacing. Starts from the state that leaves the least sum of squares: a constant gives zero.
// Across missing samples the signal is taken as linear.
std::vector<double> high_pass(std::span<const double> time, std::span<const double> x, double cutoff);

// The high-pass made ready for stamps and missing samples that stay the same, signal after signal.
class HighPass {
 public:
  // `like`: NaN where samples are missing, values of no matter.
  HighPass(std::span<const double> time, std::span<const double> like, double cutoff);
  // In place; what is missing comes out as NaN.
  void operator()(std::span<double> x) const;

 private:
  std::vector<double> keep_, gain_;  // of the state, and of the step of the signal, from the sample before
  std::vector<double> start_;        // what the state before the first sample has become; NaN where missing
  double own_ = 0;
};

// The chain in this order; what is off costs nothing.
struct Filter {
  int window = 1;               // [samples] moving average; 1 is off
  double mains = 0.0;           // [Hz] notch; 0 is off
  double mains_half_width = 1;  // [Hz]
  double drift = 0.0;           // [Hz] corner of the high-pass; 0 is off

  std::vector<double> operator()(std::span<const double> time, std::span<const double> x) const;
};

}  // namespace servodx
