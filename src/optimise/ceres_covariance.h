// The covariance of a fit by ceres::Covariance.
//
// Ceres is given the Cholesky root of J'J, scaled to a unit diagonal, in place of J: n rows for any number of them, and
// the same covariance. Limit: J'J must have full rank: a reciprocal condition above 1e-12.
#pragma once
#include <Eigen/Dense>
#include <optional>

namespace servodx {

// Inverse of `information`, J'J with a unit diagonal; none where its rank does not allow it.
std::optional<Eigen::MatrixXd> covariance_by_ceres(const Eigen::MatrixXd& information);

}  // namespace servodx
