#include "optimise/normal_equations.h"

#include <algorithm>

namespace servodx {

NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual, RobustLoss loss,
                                 double scale) {
  constexpr Eigen::Index rows_at_once = 1024;  // a block of 60 columns stays in a core's own cache
  const Eigen::Index n = jacobian.cols();
  NormalEquations out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  Eigen::MatrixXd block;
  Eigen::VectorXd changed;
  for (Eigen::Index from = 0; from < residual.size(); from += rows_at_once) {
    const Eigen::Index rows = std::min(rows_at_once, residual.size() - from);
    block = jacobian.middleRows(from, rows);
    changed = residual.segment(from, rows);
    if (loss != RobustLoss::none) {
      for (Eigen::Index i = 0; i < rows; ++i) {
        const LossValue value = robust(loss, scale, changed[i]);
        changed[i] = value.t;
        block.row(i) *= value.dt;
      }
    }
    out.matrix.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    out.gradient.noalias() += block.transpose() * changed;
  }
  out.matrix.triangularView<Eigen::StrictlyUpper>() = out.matrix.transpose();
  return out;
}

double robust_cost(const Eigen::VectorXd& residual, RobustLoss loss, double scale) {
  if (loss == RobustLoss::none) return 0.5 * residual.squaredNorm();
  double sum = 0;
  for (double e : residual) {
    const double t = robust(loss, scale, e).t;
    sum += t * t;
  }
  return 0.5 * sum;
}

}  // namespace servodx
