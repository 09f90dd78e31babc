// What a model misses, as an unknown input over time at each place where something may be missing: how much, how sure,
// and which place the residuals are best explained by. It knows no model but its linearisation along a run.
//
// The residual of the model's run is what a missing input w makes of its deviation x from that run, and noise:
//   x(k+1) = A(k) x(k) + b(k) w(k),   residual(k) = c x(k) + noise(k),   noise(k) = memory noise(k-1) + news(k)
// w is one more state (Gelb, Applied Optimal Estimation, 1974), at one place at a time: a random walk, or the sum of
// one where that is likelier. The walk's intensity, and how much larger than said each channel's news are (not
// smaller), are those of greatest likelihood: so a channel that a place does not explain counts for less, and a place
// that explains nothing has no intensity. w(t) and its variance are the fixed-interval smoother's (Rauch, Tung &
// Striebel 1965), in the form that inverts no covariance (Bryson & Frazier 1963; de Jong 1989); remembered noise is
// differenced away (Bryson & Henrikson 1968). Leaves out: two places at once; deviations so large that the model is not
// linear over them.
#pragma once
#include <functional>
#include <vector>

#include "explain/linear_run.h"

namespace servodx {

struct SmoothedInput {
  double intensity = 0;                               // [unit/sqrt(s)] of the walk, or of its slope's [unit/s/sqrt(s)]
  bool by_slope = false;                              // the slope walks
  double log_likelihood = 0;                          // of all samples that count as independent
  double gain = 0;                                    // of that, over nothing missing anywhere
  std::vector<double> by_block;                       // the same, block of time by block of time
  std::vector<std::vector<double>> value, std_error;  // [run][sample], [unit]
  std::vector<std::vector<double>> noise;             // [run][channel] news, times what they are said to be
};
struct SmootherResult {
  std::vector<SmoothedInput> places;
  double independent = 0;  // samples that count, all channels together
};
// Whether the data prefer a place to another: at odds of twenty to one, and in so many blocks of time that it is beyond
// the 95 % bound of their scatter (Vuong 1989). A walk is no law of what is missing, and a place that takes a walk less
// like a walk is not yet a worse one.
bool preferred(const SmoothedInput& place, const SmoothedInput& to);

// `typical`: [unit] a size of each place's input that would matter, where the search for its intensity begins. `told`:
// fraction done; false from it ends the work, and the places that are done are returned.
SmootherResult smooth(const std::vector<LinearRun>& runs, const std::vector<double>& typical,
                      const std::function<bool(double)>& told = {});

// One place with its intensity given, the walk `start` [unit] wide at the first sample, every sample counted in full
// and the news as large as said: for tests against exact answers.
SmoothedInput smooth_at(const std::vector<LinearRun>& runs, int place, double intensity, double start);

}  // namespace servodx
