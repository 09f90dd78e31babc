// Metrics of a life prediction against their definitions.
#include "prognosis/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "prognose/life.h"

namespace servodx {
namespace {

Life uniform(double from, double to, int n = 1000) {
  Life life;
  for (int k = 0; k < n; ++k) life.push_back(from + (to - from) * (k + 0.5) / n);
  return life;
}

TEST(Metrics, QuantilesOfAUniformLifeAreThemselves) {
  EXPECT_NEAR(life_quantile(uniform(0, 10), 0.5), 5, 1e-9);
  EXPECT_NEAR(life_quantile(uniform(0, 10), 0.05), 0.5, 1e-9);
}

TEST(Metrics, CrpsOfACertainPredictionIsItsAbsoluteError) { EXPECT_NEAR(crps(Life(50, 7.0), 10.0, 1e9), 3.0, 1e-12); }

TEST(Metrics, CrpsOfAUniformPredictionIsItsClosedForm) {
  // Uniform on [0, 1], outcome 1/2: integral (F - H)^2 = 1/12.
  EXPECT_NEAR(crps(uniform(0, 1), 0.5, 1e9), 1.0 / 12, 1e-4);
}

TEST(Metrics, CrpsPutsAPriceOnNever) {
  EXPECT_NEAR(crps(Life(10, std::numeric_limits<double>::infinity()), 40.0, 100.0), 60.0, 1e-12);
}

TEST(Metrics, AlphaLambdaCountsTheMedianWithinItsCone) {
  EXPECT_TRUE(alpha_lambda(Life(9, 11.9), 10.0, 0.2));
  EXPECT_FALSE(alpha_lambda(Life(9, 12.1), 10.0, 0.2));
  EXPECT_NEAR(mass_within(uniform(5, 15), 10.0, 0.2), 0.4, 1e-3);
}

TEST(Metrics, HorizonBeginsWhereEveryLaterPredictionHolds) {
  const std::vector<Prediction> p = {
      {10, Life(5, 90.0)}, {20, Life(5, 20.0)}, {50, Life(5, 48.0)}, {80, Life(5, 21.0)}};
  EXPECT_NEAR(prognostic_horizon(p, 100, 0.05), 50, 1e-12);  // right at 10, wrong at 20, right from 50 on
}

TEST(Metrics, ConvergenceOfAnEarlyErrorComesSooner) {
  std::vector<Prediction> early, late;
  for (int k = 0; k < 10; ++k) {
    early.push_back({k * 10.0, Life(3, 100 - k * 10.0 + (k < 3 ? 20 : 0))});
    late.push_back({k * 10.0, Life(3, 100 - k * 10.0 + (k >= 6 ? 20 : 0))});
  }
  EXPECT_LT(convergence(early, 100), convergence(late, 100));
}

TEST(Metrics, ShapesOfFeatures) {
  EXPECT_EQ(monotonicity({1, 2, 3, 4}), 1.0);
  EXPECT_EQ(monotonicity({1, 2, 1, 2, 1}), 0.0);
  EXPECT_NEAR(trendability({{0, 1, 2}, {0, 2, 4, 6}}), 1.0, 1e-9);
  EXPECT_NEAR(prognosability({{0, 1}, {0, 1}}), 1.0, 1e-12);
  EXPECT_LT(prognosability({{0, 1}, {0, 3}}), 0.7);
}

TEST(Metrics, RelativeAccuracyIsOneWhereRight) {
  EXPECT_EQ(relative_accuracy(Life(3, 10.0), 10.0), 1.0);
  EXPECT_NEAR(relative_accuracy(Life(3, 15.0), 10.0), 0.5, 1e-12);
  EXPECT_NEAR(cumulative_relative_accuracy({{90, Life(3, 10.0)}, {80, Life(3, 30.0)}}, 100), 0.75, 1e-12);
}

}  // namespace
}  // namespace servodx
