#include "optimise/normal_equations.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "optimise/robust_loss.h"

namespace servodx {
namespace {

// Three logs of 1100 rows: two columns that all share, and one that each has for itself.
Eigen::MatrixXd of_three_logs() {
  constexpr long rows = 1100;
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(3 * rows, 5);
  for (long l = 0; l < 3; ++l) {
    j.block(l * rows, 0, rows, 2).setRandom();
    j.col(2 + l).segment(l * rows, rows).setRandom();
  }
  return j;
}

TEST(NormalEquations, WhatIsEmptyIsLeftOutAndNothingElse) {
  std::srand(3);
  const Eigen::MatrixXd j = of_three_logs();
  const Eigen::VectorXd e = Eigen::VectorXd::Random(j.rows());
  const RowBlocks blocks = row_blocks(j);
  EXPECT_EQ(blocks.filled.front(), (std::vector<Eigen::Index>{0, 1, 2}));
  const NormalEquations n = normal_equations(j, e, RobustLoss::none, 1);
  EXPECT_LT((n.matrix - j.transpose() * j).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((n.gradient - j.transpose() * e).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((transposed_product(j, blocks, e) - n.gradient).cwiseAbs().maxCoeff(), 1e-10);
  const Eigen::VectorXd step = Eigen::VectorXd::Random(5);
  EXPECT_LT((product(j, blocks, step) - j * step).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(NormalEquations, RowsCountAsTheLossChangesThem) {
  std::srand(4);
  const Eigen::MatrixXd j = of_three_logs();
  const Eigen::VectorXd e = 5 * Eigen::VectorXd::Random(j.rows());
  const NormalEquations n = normal_equations(j, e, RobustLoss::compressed, 3);
  Eigen::MatrixXd changed = j;
  Eigen::VectorXd t = e;
  for (long i = 0; i < e.size(); ++i) {
    const LossValue value = robust(RobustLoss::compressed, 3, e[i]);
    changed.row(i) *= value.dt, t[i] = value.t;
  }
  EXPECT_LT((n.matrix - changed.transpose() * changed).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((n.gradient - changed.transpose() * t).cwiseAbs().maxCoeff(), 1e-10);
}

TEST(NormalEquations, AStepTeachesEachBlockWhatItMissedAndFillsNothing) {
  std::srand(5);
  const Eigen::MatrixXd before = of_three_logs();
  const RowBlocks blocks = row_blocks(before);
  const Eigen::VectorXd step = Eigen::VectorXd::Random(5);
  const Eigen::VectorXd missed = Eigen::VectorXd::Random(before.rows());
  Eigen::MatrixXd after = before;
  learn_step(after, blocks, step, missed);
  EXPECT_LT((after * step - before * step - missed).cwiseAbs().maxCoeff(), 1e-10) << "right along the step";
  EXPECT_EQ(row_blocks(after).filled, blocks.filled);
  Eigen::VectorXd across = Eigen::VectorXd::Zero(5);
  across[0] = step[1], across[1] = -step[0];
  EXPECT_LT((after * across - before * across).cwiseAbs().maxCoeff(), 1e-10) << "as it was across it";
}

}  // namespace
}  // namespace servodx
