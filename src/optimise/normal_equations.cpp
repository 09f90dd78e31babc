#include "optimise/normal_equations.h"

#include <algorithm>
#include <vector>

namespace servodx {

namespace {

// task(columns, first row, rows), a block each.
template <class Task>
void each_block(const RowBlocks& blocks, Eigen::Index rows, Task&& task) {
  for (std::size_t b = 0; b < blocks.filled.size(); ++b) {
    const Eigen::Index from = static_cast<Eigen::Index>(b) * RowBlocks::rows;
    task(blocks.filled[b], from, std::min(RowBlocks::rows, rows - from));
  }
}

void change(Eigen::MatrixXd& block, Eigen::VectorXd& residual, RobustLoss loss, double scale) {
  for (Eigen::Index i = 0; i < residual.size(); ++i) {
    const LossValue value = robust(loss, scale, residual[i]);
    residual[i] = value.t;
    block.row(i) *= value.dt;
  }
}

}  // namespace

RowBlocks row_blocks(const Eigen::MatrixXd& jacobian) {
  RowBlocks out;
  for (Eigen::Index from = 0; from < jacobian.rows(); from += RowBlocks::rows) {
    const Eigen::Index rows = std::min(RowBlocks::rows, jacobian.rows() - from);
    std::vector<Eigen::Index>& filled = out.filled.emplace_back();
    for (Eigen::Index j = 0; j < jacobian.cols(); ++j) {
      const double* column = &jacobian(from, j);
      if (std::any_of(column, column + rows, [](double v) { return v != 0.0; })) filled.push_back(j);
    }
  }
  return out;
}

NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks,
                                 const Eigen::VectorXd& residual, RobustLoss loss, double scale) {
  const Eigen::Index n = jacobian.cols();
  NormalEquations out{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  Eigen::MatrixXd block, square;
  Eigen::VectorXd changed;
  each_block(blocks, jacobian.rows(), [&](const auto& filled, Eigen::Index from, Eigen::Index rows) {
    block.resize(rows, static_cast<Eigen::Index>(filled.size()));
    for (Eigen::Index k = 0; k < block.cols(); ++k)
      block.col(k) = jacobian.col(filled[static_cast<std::size_t>(k)]).segment(from, rows);
    changed = residual.segment(from, rows);
    if (loss != RobustLoss::none) change(block, changed, loss, scale);
    square.setZero(block.cols(), block.cols());
    square.selfadjointView<Eigen::Lower>().rankUpdate(block.transpose());
    out.matrix(filled, filled) += square;
    out.gradient(filled) += block.transpose() * changed;
  });
  out.matrix.triangularView<Eigen::StrictlyUpper>() = out.matrix.transpose();
  return out;
}

NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual, RobustLoss loss,
                                 double scale) {
  return normal_equations(jacobian, row_blocks(jacobian), residual, loss, scale);
}

Eigen::VectorXd product(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& step) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(jacobian.rows());
  each_block(blocks, jacobian.rows(), [&](const auto& filled, Eigen::Index from, Eigen::Index rows) {
    for (const Eigen::Index j : filled) out.segment(from, rows) += step[j] * jacobian.col(j).segment(from, rows);
  });
  return out;
}

Eigen::VectorXd transposed_product(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& v) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(jacobian.cols());
  each_block(blocks, jacobian.rows(), [&](const auto& filled, Eigen::Index from, Eigen::Index rows) {
    for (const Eigen::Index j : filled) out[j] += jacobian.col(j).segment(from, rows).dot(v.segment(from, rows));
  });
  return out;
}

void learn_step(Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& step,
                const Eigen::VectorXd& missed) {
  each_block(blocks, jacobian.rows(), [&](const auto& filled, Eigen::Index from, Eigen::Index rows) {
    const double square = step(filled).squaredNorm();
    if (square <= 0) return;
    for (const Eigen::Index j : filled)
      if (step[j] != 0.0) jacobian.col(j).segment(from, rows) += step[j] / square * missed.segment(from, rows);
  });
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
