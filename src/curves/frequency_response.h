// Frequency response between two sampled signals: at each frequency a Hann-windowed Fourier sum over windows of a fixed
// number of cycles, averaged (Welch's method at constant relative bandwidth). Suits sweeps and noise alike.
//
// The window moves by a quarter of its length; a window without the frequency weighs nothing, as the sums are weighted
// by what the input holds. Limits: time stamps nearly even (samples are taken as they lie); the mean of each window is
// left out; below ten cycles of the record nothing is reported.
#pragma once
#include <span>
#include <vector>

namespace servodx::curves {

struct ResponsePoint {
  double frequency = 0;  // [Hz]
  double gain = 0;       // output over input
  double phase = 0;      // [rad] continuous over the points, from the first
  double coherence = 0;  // 0..1
};

// Points with a coherence of at least `coherence`, lowest frequency first.
std::vector<ResponsePoint> frequency_response(std::span<const double> time, std::span<const double> input,
                                              std::span<const double> output, double coherence = 0.8);

// Where gain over the lowest points' gain first falls to `ratio`, and where the phase first lags by `lag` [rad]; NaN
// where the points do not reach it.
double frequency_of_gain(std::span<const ResponsePoint> points, double ratio);
double frequency_of_lag(std::span<const ResponsePoint> points, double lag);

}  // namespace servodx::curves
