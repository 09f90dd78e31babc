// NLopt behind the same seam: known minima, walls, and a cost whose derivatives are worth nothing.
#include "optimise/derivative_free.h"

#include <gtest/gtest.h>

#include <cmath>

#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"

namespace servodx {
namespace {

BatchEvaluate batch(std::function<Eigen::VectorXd(const Point&)> f) {
  return [f = std::move(f)](std::span<const Point> points) {
    std::vector<Evaluation> out;
    for (const Point& x : points) out.push_back({true, f(x)});
    return out;
  };
}

TEST(DerivativeFree, FindsAMinimumInsideAndAtAWall) {
  const auto bowl = batch([](const Point& x) {
    Eigen::VectorXd r(4);
    r << 10 * (x[0] - 0.3), 3 * (x[1] - 0.8) + (x[0] - 0.3), 5 * (x[2] - 1.4), 1.0;
    return r;
  });
  const DerivativeFreeResult found = minimise_without_derivatives(3, bowl, {0.5, 0.5, 0.5});
  EXPECT_NEAR(found.point[0], 0.3, 1e-3);
  EXPECT_NEAR(found.point[1], 0.8, 3e-3);
  EXPECT_NEAR(found.point[2], 1.0, 1e-9);
  EXPECT_EQ(found.failed_evaluations, 0);
}

TEST(DerivativeFree, TellsHowItStoppedAfterHowManyPoints) {
  const auto bowl = batch([](const Point& x) { return Eigen::Vector3d(x[0] - 0.3, 2 * (x[1] - 0.8), 1); });
  const auto stop = [&](const DerivativeFreeOptions& options) {
    const DerivativeFreeResult found = minimise_without_derivatives(2, bowl, {0.5, 0.5}, options);
    EXPECT_EQ(found.stop.count, found.evaluations);
    EXPECT_FALSE(found.stop.at);
    return found.stop.how;
  };
  using How = SearchStop::How;
  EXPECT_EQ(stop({.max_evaluations = 7, .cost_tolerance = 0, .step_tolerance = 1e-12}), How::bobyqa_evaluation_limit);
  EXPECT_EQ(stop({.cost_tolerance = 0}), How::bobyqa_step_converged);
  EXPECT_EQ(stop({.cost_tolerance = 0.5, .step_tolerance = 1e-12}), How::bobyqa_cost_converged);
  EXPECT_EQ(stop({.progress = [](long, double) { return false; }}), How::bobyqa_interrupted);
}

TEST(DerivativeFree, RidesOverRoughnessThatSpoilsDifferences) {
  const auto rough = batch([](const Point& x) {
    Eigen::VectorXd r(2);
    for (int i = 0; i < 2; ++i) r[i] = x[i] - 0.6 + 2e-4 * std::sin(3e5 * x[i]);
    return r;
  });
  const DerivativeFreeResult found = minimise_without_derivatives(2, rough, {0.1, 0.9});
  EXPECT_LT(found.cost, 1e-6);
}

TEST(DerivativeFree, AFailedPointDoesNotStopIt) {
  int calls = 0;
  const BatchEvaluate hole = [&](std::span<const Point> points) {
    std::vector<Evaluation> out;
    for (const Point& x : points) {
      ++calls;
      if (x[0] > 0.55)
        out.push_back({false, {}});
      else
        out.push_back({true, Eigen::VectorXd::Constant(1, x[0] - 0.5)});
    }
    return out;
  };
  const DerivativeFreeResult found = minimise_without_derivatives(2, hole, {0.2, 0.5});
  EXPECT_LT(found.cost, 1e-5);
  EXPECT_EQ(found.evaluations, calls);
}

}  // namespace
}  // namespace servodx
