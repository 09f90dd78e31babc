// Profile likelihood of one free number: all others fitted again while it is held, and moved until the misfit has risen
// by what 95 % allow (chi-squared of one number: 3.84 in -2 log likelihood). Says where the interval from the curvature
// at the end is too short, too long or not symmetric. Costs some ten short fits a number.
#pragma once
#include "fit/problem.h"
#include "optimise/unit_cube.h"

namespace servodx {

struct ProfileInterval {
  double lower = 0, upper = 1;                  // of the unit interval
  bool lower_open = false, upper_open = false;  // the bound was reached first
};

// `best`: where the problem's misfit is least; `covariance` of all free numbers there.
ProfileInterval profile(const FitProblem& problem, const Point& best, int j, const Eigen::MatrixXd& covariance);

}  // namespace servodx
