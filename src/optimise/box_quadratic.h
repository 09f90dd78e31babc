// The convex quadratic on a box: minimise 0.5*s'As + g's with lower <= s <= upper, A symmetric positive definite, lower
// <= 0 <= upper. Primal active-set method: solve on the free set, stop at the first wall met, fix it, re-solve; let go
// of the wall whose multiplier has the wrong sign, and so on. Finite for a strictly convex A. Dense Cholesky, so meant
// for n up to a few hundred. Source: Lawson and Hanson, Solving Least Squares Problems (1974), ch. 23; Stark and
// Parker, Bounded-variable least squares (1995).
#pragma once
#include <Eigen/Dense>
#include <vector>

namespace servodx {

struct BoxQuadraticResult {
  Eigen::VectorXd step;
  std::vector<int> wall;  // -1 held at lower, +1 held at upper, 0 free
  double decrease = 0;    // -(0.5*s'As + g's) >= 0
  bool exact = true;  // false: the iteration limit was met; the step is feasible and descends, but the multipliers may
                      // not all fit
};

BoxQuadraticResult minimise_box_quadratic(const Eigen::MatrixXd& a, const Eigen::VectorXd& g,
                                          const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

}  // namespace servodx
