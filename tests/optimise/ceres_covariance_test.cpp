#include "optimise/ceres_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <optional>

namespace servodx::test {
namespace {

// By hand: the inverse of [1 c; c 1] is [1 -c; -c 1] / (1 - c^2).
TEST(CeresCovariance, OfTwoColumnsIsTheOneByHand) {
  for (const double c : {0.0, 0.5, -0.8, 0.9999}) {
    const std::optional<Eigen::MatrixXd> found = covariance_by_ceres((Eigen::Matrix2d() << 1, c, c, 1).finished());
    ASSERT_TRUE(found) << c;
    const double scale = 1 / (1 - c * c);
    EXPECT_NEAR((*found)(0, 0), scale, 1e-9 * scale) << c;
    EXPECT_NEAR((*found)(0, 1), -c * scale, 1e-9 * scale) << c;
    EXPECT_NEAR((*found)(1, 0), -c * scale, 1e-9 * scale) << c;
    EXPECT_NEAR((*found)(1, 1), scale, 1e-9 * scale) << c;
  }
}

TEST(CeresCovariance, ThereIsNoneWhereTwoColumnsAreOne) {
  EXPECT_FALSE(covariance_by_ceres(Eigen::Matrix2d::Ones()));
  EXPECT_FALSE(covariance_by_ceres((Eigen::Matrix2d() << 1, 1 - 1e-15, 1 - 1e-15, 1).finished()));
  EXPECT_FALSE(covariance_by_ceres(Eigen::MatrixXd()));
}

}  // namespace
}  // namespace servodx::test
