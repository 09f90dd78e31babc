// The points of a growth as matrices, and what is supposed of them before any is read.
#pragma once
#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "prognose/growth.h"
#include "prognose/growth_regression.h"

namespace servodx {

struct GrowthData {
  GrowthData(std::vector<GrowthPoint> in_order, const GrowthPrior& prior);

  std::vector<GrowthPoint> points;
  double first = 0, now = 0, length = 1;          // [h] of the first point, of the last, between them
  std::vector<std::size_t> added;                 // features that add to y
  Eigen::MatrixXd terms;                          // what of the base shows, and these features
  Terms mean, sd;                                 // of their coefficients
  Eigen::VectorXd y, variance, exposed, stretch;  // see GrowthPoint
  Eigen::MatrixXd drift;                          // covariance of a Wiener process, 1 over the record
  Eigen::MatrixXd by_oil;                         // features that change what is grown
  double worn = 1;                                // of what wears, that matters

  long n() const { return y.size(); }
  double onset_at(double part) const { return first + part * (now - first); }  // [h]
};

}  // namespace servodx
