// A model linearised along its run, as a filter takes it: how a deviation goes from sample to sample, what is missing
// adds to it at each place, and what of it each channel shows. It knows no model but this.
//
//   x(k+1) = A(k) x(k) + b(k) w(k),   residual(k) = c x(k) + noise(k),   noise(k) = memory noise(k-1) + news(k)
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace servodx {

// A channel's residual along a run; n states.
struct LinearChannel {
  Eigen::VectorXd shows;         // [n] of a deviation; what is missing shows from the next sample on
  std::vector<double> residual;  // [SI] measured less simulated, a sample each; NaN where missing
  std::vector<double> sigma;     // [SI] of the news, at least; a sample each
  double memory = 0;             // of the noise from sample to sample, below 1
};
struct LinearRun {
  std::vector<double> time;                 // [s]
  std::vector<Eigen::MatrixXd> transition;  // [sample] to the next: n x (n + m), A and a column b for each place
  Eigen::VectorXd start;                    // [n] standard deviation of x at the first sample
  std::vector<LinearChannel> channels;
};

// Of all runs alike; samples of all runs together; [s] of the longest.
std::size_t states_of(const std::vector<LinearRun>& runs);
std::size_t samples_of(const std::vector<LinearRun>& runs);
double longest_of(const std::vector<LinearRun>& runs);

// Without the states that no input, and nothing unknown at the start, ever reaches, or that no channel ever shows.
std::vector<LinearRun> pruned(const std::vector<LinearRun>& runs);

// Every `stride`-th sample of a run.
LinearRun thinned(const LinearRun& run, int stride);

}  // namespace servodx
