// The normal equations of a residual at one point, each row as the loss changes it, and what else a damped step asks of
// a tall Jacobian. All go block by block over the rows, and of each block over its columns that are not zero: a log's
// own values move that log's rows alone, so that of ten logs' Jacobian most is empty.
#pragma once
#include <Eigen/Dense>
#include <vector>

#include "optimise/robust_loss.h"

namespace servodx {

struct NormalEquations {
  Eigen::MatrixXd matrix;    // J'J
  Eigen::VectorXd gradient;  // J'e
};

// Columns that are not zero, a block of rows each.
struct RowBlocks {
  static constexpr Eigen::Index rows = 1024;  // 60 columns of them stay in a core's own cache
  std::vector<std::vector<Eigen::Index>> filled;
};
RowBlocks row_blocks(const Eigen::MatrixXd& jacobian);

NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks,
                                 const Eigen::VectorXd& residual, RobustLoss loss, double scale);
NormalEquations normal_equations(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& residual, RobustLoss loss,
                                 double scale);

Eigen::VectorXd product(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& step);
Eigen::VectorXd transposed_product(const Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& v);

// The Jacobian after a step whose residual it `missed`: right along the step, as it was across it (Broyden 1965). A
// block of rows learns in its columns that are not zero (Schubert 1970).
void learn_step(Eigen::MatrixXd& jacobian, const RowBlocks& blocks, const Eigen::VectorXd& step,
                const Eigen::VectorXd& missed);

// The sum of rho(e_i).
double robust_cost(const Eigen::VectorXd& residual, RobustLoss loss, double scale);

}  // namespace servodx
