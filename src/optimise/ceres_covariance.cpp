#include "optimise/ceres_covariance.h"

#include <ceres/cost_function.h>
#include <ceres/covariance.h>
#include <ceres/problem.h>
#include <ceres/types.h>

#include <Eigen/Cholesky>
#include <utility>
#include <vector>

namespace servodx {
namespace {

// Ceres refuses from 1e-14 on, and says so to stderr. The estimate of a condition may be off by some tens of columns.
constexpr double least_condition = 1e-12;

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Rows of the root times x, without an offset: only the Jacobian counts.
class Root final : public ceres::CostFunction {
 public:
  explicit Root(RowMajor root) : root_(std::move(root)) {
    set_num_residuals(static_cast<int>(root_.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(root_.cols()));
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    Eigen::Map<Eigen::VectorXd>(residuals, root_.rows()) =
        root_ * Eigen::Map<const Eigen::VectorXd>(x[0], root_.cols());
    if (jacobians && jacobians[0]) Eigen::Map<RowMajor>(jacobians[0], root_.rows(), root_.cols()) = root_;
    return true;
  }

 private:
  RowMajor root_;
};

}  // namespace

std::optional<Eigen::MatrixXd> covariance_by_ceres(const Eigen::MatrixXd& information) {
  const Eigen::LLT<Eigen::MatrixXd> factor(information);
  if (information.rows() == 0 || factor.info() != Eigen::Success || !(factor.rcond() > least_condition))
    return std::nullopt;
  RowMajor root = factor.matrixU();
  std::vector<double> x(static_cast<std::size_t>(information.rows()), 0.0);
  ceres::Problem problem;
  problem.AddResidualBlock(new Root(std::move(root)), nullptr, x.data());
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::DENSE_SVD;
  options.num_threads = 1;
  ceres::Covariance covariance(options);
  const std::vector<std::pair<const double*, const double*>> blocks = {{x.data(), x.data()}};
  if (!covariance.Compute(blocks, &problem)) return std::nullopt;
  RowMajor out(information.rows(), information.rows());
  if (!covariance.GetCovarianceBlock(x.data(), x.data(), out.data())) return std::nullopt;
  return Eigen::MatrixXd(out);
}

}  // namespace servodx
