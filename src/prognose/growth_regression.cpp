#include "prognose/growth_regression.h"

#include <cmath>

namespace servodx {

GrowthRegression::GrowthRegression(const Eigen::MatrixXd& terms, const Eigen::VectorXd& y, const Eigen::MatrixXd& noise,
                                   const Terms& prior_mean, const Terms& prior_sd)
    : factor_(noise) {
  if (noise.isDiagonal(0)) alone_ = noise.diagonal().cwiseSqrt().cwiseInverse();
  x_ = whitened(terms);
  residual_ = whitened(y - terms * prior_mean);
  const Terms prior = prior_sd.cwiseAbs2().cwiseInverse();
  TermMatrix a = x_.transpose() * x_;
  a.diagonal() += prior;
  precision_.compute(a);
  right_ = x_.transpose() * residual_;
  const Terms shift = precision_.solve(right_);
  mean_ = prior_mean + shift;
  covariance_ = precision_.solve(TermMatrix::Identity(a.rows(), a.cols()));
  const auto log_det = [](const auto& llt) { return 2 * llt.matrixLLT().diagonal().array().log().sum(); };
  log_evidence_ = -0.5 * (residual_.squaredNorm() - right_.dot(shift) + log_det(factor_) + log_det(precision_) -
                          prior.array().log().sum());
}

Eigen::MatrixXd GrowthRegression::whitened(const Eigen::MatrixXd& of) const {
  if (alone_.size() > 0) return alone_.asDiagonal() * of;
  return factor_.matrixL().solve(of);
}

GrownRegression GrowthRegression::without_growth() const {
  return {log_evidence_, 0, 0, Eigen::Vector2d::Zero(), mean_, Terms::Zero(mean_.size()), covariance_(0, 0)};
}

GrownRegression GrowthRegression::with(const Eigen::Ref<const Eigen::MatrixXd>& g,
                                       const Eigen::Ref<const Eigen::MatrixXd>& crossed,
                                       const Eigen::Vector3d& prior_mean, const Eigen::Vector3d& prior_sd) const {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
  using Cross = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_terms, 3>;
  const long m = g.cols();
  const Cross cross = crossed, fall = precision_.solve(cross);
  const SmallVector prior = prior_sd.head(m).cwiseAbs2().cwiseInverse(),
                    supposed = prior.cwiseProduct(prior_mean.head(m));
  Small own = g.transpose() * g - cross.transpose() * fall;
  own.diagonal() += prior;
  const SmallVector pull = g.transpose() * residual_ - fall.transpose() * right_ + supposed;
  const Eigen::LLT<Small> inverse(own);
  const Small spread = inverse.solve(Small::Identity(m, m));
  const SmallVector at = spread * pull, per_a = spread.col(0) / spread(0, 0);
  GrownRegression out;
  out.mean = at[0], out.variance = spread(0, 0);
  out.d.head(m - 1) = at.tail(m - 1);
  out.terms = mean_ - fall * at;
  out.tilt = fall * per_a;
  const SmallVector of_base = fall.row(0).transpose();
  out.base_variance =
      covariance_(0, 0) + of_base.dot(spread * of_base) - std::pow(of_base.dot(spread.col(0)), 2) / spread(0, 0);
  const double log_det = 2 * inverse.matrixLLT().diagonal().array().log().sum();
  out.log_evidence =
      log_evidence_ + 0.5 * (pull.dot(at) - supposed.dot(prior_mean.head(m)) - log_det + prior.array().log().sum());
  return out;
}

}  // namespace servodx
