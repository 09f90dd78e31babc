// What bounds hold back of a fit, against linear least squares, whose least lies where it is known to.
#include "prognose/held_back.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimise/unit_cube.h"

namespace servodx {
namespace {

// Residuals A (x - least): columns alike, so that the others take up what one may not.
const Eigen::MatrixXd alike = (Eigen::MatrixXd(4, 3) << 1, 0.9, 0, 0, 1, 0.5, 2, 0, 1, 0.3, 0.4, 3).finished();

struct End {
  Point at;
  Eigen::VectorXd least, held;
};

// Of a fit whose first number ends at `wall`, the others where they are best beside it.
End end_with_first_at(double wall, const Eigen::VectorXd& least) {
  const Eigen::MatrixXd others = alike.rightCols(2);
  const Eigen::VectorXd right = alike * least - alike.col(0) * wall;
  const Eigen::VectorXd best = (others.transpose() * others).ldlt().solve(others.transpose() * right);
  const Eigen::VectorXd end = (Eigen::VectorXd(3) << wall, best).finished();
  const Eigen::MatrixXd covariance = (alike.transpose() * alike).inverse();
  const Point at(end.data(), end.data() + end.size());
  return {at, least, held_back(at, alike * (end - least), alike, covariance)};
}

TEST(HeldBack, IsTheWayToTheLeastBeyondTheBoundOfEveryNumber) {
  for (const double beyond : {1.4, -0.3}) {
    const End end = end_with_first_at(beyond > 0.5 ? 1.0 : 0.0, Eigen::Vector3d(beyond, 0.3, 0.6));
    for (std::size_t j = 0; j < end.at.size(); ++j) {
      const auto k = static_cast<long>(j);
      EXPECT_NEAR(end.held[k], std::abs(end.least[k] - end.at[j]), 1e-12) << beyond << " " << j;
    }
    EXPECT_GT(end.held[1], 0.01) << "the others have taken up nothing";
  }
}

TEST(HeldBack, IsNoughtWhereNoBoundHolds) {
  EXPECT_LT(end_with_first_at(1.0, Eigen::Vector3d(1.0, 0.3, 0.6)).held.norm(), 1e-12) << "the least is at the bound";
  EXPECT_EQ(end_with_first_at(1.0, Eigen::Vector3d(0.7, 0.3, 0.6)).held.norm(), 0) << "a fit that stopped at the bound";
  EXPECT_EQ(end_with_first_at(0.9, Eigen::Vector3d(1.4, 0.3, 0.6)).held.norm(), 0) << "a fit that stopped before it";
}

}  // namespace
}  // namespace servodx
