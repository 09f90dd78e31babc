// Gaussian linear regression of a figure at one noise level and wander: its evidence without growth, and what a growth
// of given course adds to it. Everything is whitened by the noise's covariance, all coefficients have Gaussian priors,
// and all integrals are closed (Bishop 2006, sec. 3.5). Limits: at most `most_terms` terms, three columns a growth.
#pragma once
#include <Eigen/Dense>

namespace servodx {

// Base and features; the growth is set apart.
inline constexpr int most_terms = 8;
using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_terms, 1>;
using TermMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_terms, most_terms>;

// Of the size a of a growth, with d, what the oil makes of it, integrated out.
struct GrownRegression {
  double log_evidence = 0, mean = 0, variance = 0;
  Eigen::Vector2d d = Eigen::Vector2d::Zero();
  Terms terms;               // given a at its mean
  Terms tilt;                // how far they fall for a unit of a
  double base_variance = 0;  // of the first of them, given a
};

class GrowthRegression {
 public:
  GrowthRegression(const Eigen::MatrixXd& terms, const Eigen::VectorXd& y, const Eigen::MatrixXd& noise,
                   const Terms& prior_mean, const Terms& prior_sd);

  double log_evidence() const { return log_evidence_; }  // without growth
  GrownRegression without_growth() const;
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& of) const;
  Eigen::MatrixXd crossed(const Eigen::MatrixXd& whitened) const { return x_.transpose() * whitened; }
  Eigen::VectorXd solved(const Eigen::VectorXd& of) const { return factor_.solve(of); }  // by the noise's covariance
  // `g`, whitened: the growth and its products with the features that d stands for; `crossed`: of it.
  GrownRegression with(const Eigen::Ref<const Eigen::MatrixXd>& g, const Eigen::Ref<const Eigen::MatrixXd>& crossed,
                       const Eigen::Vector3d& prior_mean, const Eigen::Vector3d& prior_sd) const;

 private:
  Eigen::LLT<Eigen::MatrixXd> factor_;  // of the noise's covariance
  Eigen::VectorXd alone_;               // inverse spread of each point where none depends on another
  Eigen::MatrixXd x_;                   // terms, whitened
  Eigen::VectorXd residual_;            // whitened, of the prior mean
  Eigen::LLT<TermMatrix> precision_;
  Terms right_, mean_;
  TermMatrix covariance_;
  double log_evidence_ = 0;
};

}  // namespace servodx
