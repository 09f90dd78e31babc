// Which free numbers the data can tell apart, from the local sensitivities (Brun, Reichert, Kuensch 2001:
// collinearity).
#pragma once
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "servodx/table.h"

namespace servodx {

struct Identifiability {
  std::vector<RowVerdict> verdict;                // bounded, flat or confounded
  std::vector<std::vector<int>> confounded_with;  // columns that together do what this one does
  std::vector<double> norm;                       // of the column, in sigmas per unit interval
};

// jacobian: rows in sigmas of independent samples, columns per unit interval; `candidates` marks columns that may be
// frozen (nuisances are not). Greedy: strongest first; a column whose part that the kept ones do not span is shorter
// than its norm over `collinearity_limit` is confounded, unless that part alone still determines it to a quarter of
// its interval (`enough` sigmas): an index says that two effects are alike, not that the data cannot tell them apart;
// one that moves no channel by `flat_limit` sigmas over the whole interval is flat (fit/constants.h).
Identifiability identify(const Eigen::MatrixXd& jacobian, const std::vector<char>& candidates);

// Covariance of the free columns (inverse of J^T J); rows and columns of frozen ones are zero. By Ceres; where columns
// are alike to rounding, and J^T J has no inverse, its pseudo-inverse.
Eigen::MatrixXd covariance_of(const Eigen::MatrixXd& jacobian, const std::vector<char>& kept);

}  // namespace servodx
