// How far the numbers of a fit would move if their ranges did not end where they do.
//
// Where a bound holds a number against the cost, the curvature there says how steep the cost is, not where its least
// would be: the worse the number fits, the steeper it is, and the less it seems to err. Newton's step from the part of
// the gradient that pushes against bounds leads to that least, of the number itself and of those that have taken what
// it may not. Exact where the residuals are linear; nought where no bound holds anything.
#pragma once
#include <Eigen/Dense>

#include "optimise/unit_cube.h"

namespace servodx {

// [of the unit interval] of each number, at the end of a fit; `covariance`: the inverse of J'J.
Eigen::VectorXd held_back(const Point& end, const Eigen::VectorXd& residual, const Eigen::MatrixXd& jacobian,
                          const Eigen::MatrixXd& covariance);

}  // namespace servodx
