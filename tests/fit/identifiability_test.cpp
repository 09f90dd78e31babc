#include "fit/identifiability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "servodx/table.h"

namespace servodx {
namespace {

Eigen::MatrixXd random_jacobian(long rows, long columns, unsigned seed) {
  Random random(seed);
  Eigen::MatrixXd j(rows, columns);
  for (long c = 0; c < columns; ++c)
    for (long r = 0; r < rows; ++r) j(r, c) = random.normal();
  return j;
}

TEST(Identifiability, IndependentColumnsAreFree) {
  const Identifiability id = identify(random_jacobian(200, 5, 1), std::vector<char>(5, 1));
  for (const RowVerdict v : id.verdict) EXPECT_EQ(v, RowVerdict::bounded);
}

TEST(Identifiability, DuplicatedColumnIsConfoundedWithTheStrongerOne) {
  Eigen::MatrixXd j = random_jacobian(200, 4, 2);
  j.col(1) *= 3.0;
  j.col(3) = 0.5 * j.col(1);
  const Identifiability id = identify(j, std::vector<char>(4, 1));
  EXPECT_EQ(id.verdict, (std::vector<RowVerdict>{RowVerdict::bounded, RowVerdict::bounded, RowVerdict::bounded,
                                                 RowVerdict::confounded}));
  EXPECT_EQ(id.confounded_with[3], std::vector<int>{1});
}

TEST(Identifiability, SumOfTwoColumnsIsConfoundedWithBoth) {
  Eigen::MatrixXd j = random_jacobian(300, 4, 3);
  j.col(0) *= 2.0;
  j.col(1) *= 2.0;
  j.col(2) = 0.4 * (j.col(0) + j.col(1));
  const Identifiability id = identify(j, std::vector<char>(4, 1));
  EXPECT_EQ(id.verdict[2], RowVerdict::confounded);
  std::vector<int> with = id.confounded_with[2];
  std::sort(with.begin(), with.end());
  EXPECT_EQ(with, (std::vector<int>{0, 1}));
}

TEST(Identifiability, LimitIsTheCollinearityIndex) {
  // Part of the second column that the first does not span: 1 / index of its length.
  for (double index : {10.0, 20.0}) {
    Eigen::MatrixXd j = Eigen::MatrixXd::Zero(2, 2);
    j(0, 0) = 100.0;
    j(0, 1) = 50.0 * std::sqrt(1.0 - 1.0 / (index * index));
    j(1, 1) = 50.0 / index;
    EXPECT_EQ(identify(j, {1, 1}).verdict[1], index < 15.0 ? RowVerdict::bounded : RowVerdict::confounded) << index;
  }
}

TEST(Identifiability, ZeroColumnIsFlatAndSoIsAWeakOne) {
  Eigen::MatrixXd j = random_jacobian(100, 4, 4);
  j.col(1).setZero();
  j.col(2) *= 0.5 / j.col(2).norm();  // half a sigma over its whole interval
  const Identifiability id = identify(j, std::vector<char>(4, 1));
  EXPECT_EQ(id.verdict,
            (std::vector<RowVerdict>{RowVerdict::bounded, RowVerdict::flat, RowVerdict::flat, RowVerdict::bounded}));
  EXPECT_EQ(id.norm[1], 0.0);
}

TEST(Identifiability, NuisanceIsNeverFrozenAndTakesItsTwinWithIt) {
  Eigen::MatrixXd j = random_jacobian(100, 3, 5);
  j.col(0) = 10.0 * j.col(2);
  const Identifiability id = identify(j, {1, 1, 0});
  EXPECT_EQ(id.verdict, (std::vector<RowVerdict>{RowVerdict::confounded, RowVerdict::bounded, RowVerdict::bounded}));
  EXPECT_EQ(id.confounded_with[0], std::vector<int>{2});
}

TEST(Covariance, OfALinearProblemIsTheAnalyticOne) {
  const Eigen::MatrixXd j = random_jacobian(60, 4, 6);
  const Eigen::MatrixXd expected = (j.transpose() * j).inverse();
  const Eigen::MatrixXd found = covariance_of(j, std::vector<char>(4, 1));
  EXPECT_LT((found - expected).norm(), 1e-12 * expected.norm());
}

TEST(Covariance, FrozenColumnHasNoneAndDoesNotWidenTheOthers) {
  const Eigen::MatrixXd j = random_jacobian(60, 4, 7);
  const Eigen::MatrixXd found = covariance_of(j, {1, 0, 1, 1});
  Eigen::MatrixXd kept(60, 3);
  kept << j.col(0), j.col(2), j.col(3);
  const Eigen::MatrixXd expected = (kept.transpose() * kept).inverse();
  EXPECT_NEAR(found(0, 2), expected(0, 1), 1e-12 * expected.norm());
  EXPECT_NEAR(found(3, 3), expected(2, 2), 1e-12 * expected.norm());
  EXPECT_EQ(found.row(1).norm() + found.col(1).norm(), 0.0);
}

TEST(Covariance, IsThatOfTheEstimatesOfALinearProblem) {
  // 2000 draws of noise: the scatter of the least-squares solution.
  const Eigen::MatrixXd j = random_jacobian(20, 2, 8);
  const Eigen::MatrixXd stated = covariance_of(j, {1, 1});
  const Eigen::MatrixXd solve = (j.transpose() * j).inverse() * j.transpose();
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(2, 2);
  constexpr int draws = 2000;
  for (unsigned d = 0; d < draws; ++d) {
    const Eigen::VectorXd x = solve * random_jacobian(20, 1, 1000 + d);
    scatter += x * x.transpose() / draws;
  }
  EXPECT_LT((scatter - stated).norm(), 0.1 * stated.norm());
}

}  // namespace
}  // namespace servodx
