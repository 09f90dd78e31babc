// How far a residual lies from what is usual, channel by channel: a sum of squares where a channel errs as usual, its
// logarithm beyond.
//
// -2 log likelihood of a residual, each channel's variance unknown but not below what is usual for it. A sum of squares
// would drown the names of a large effect: one that leaves a hundredth of the square does far better than one that
// leaves a tenth, and by hardly more of the sum. Rows of priors count as they are.
#pragma once
#include <Eigen/Core>
#include <vector>

#include "explain/subject.h"
#include "optimise/box_least_squares.h"

namespace servodx {

double deviance_of(const Subject& subject, const Eigen::VectorXd& residual);
// Independent samples.
double degrees_of(const Subject& subject);
// Rows before those of the priors.
long data_rows(const Subject& subject);
// Samples of each log, whatever it shows.
std::vector<long> samples_of_logs(const Subject& subject);
// The deviance as a sum of squares: about this residual, the weight of each row that makes their gradients alike.
// Refitted with the weights of what is left, a sum of squares arrives where the deviance is least.
Eigen::VectorXd weights_at(const Subject& subject, const Eigen::VectorXd& residual);
LeastSquaresProblem weighed(const LeastSquaresProblem& problem, const Eigen::VectorXd& weights);

}  // namespace servodx
