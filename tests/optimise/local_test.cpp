// The local stage: our search, Ceres, and BOBYQA where derivatives prove false.
#include "optimise/local.h"

#include <gtest/gtest.h>

#include <cmath>
#include <span>

#include "functions.h"
#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "optimise/unit_cube.h"
#include "weak_problem.h"

namespace servodx::test {
namespace {

TEST(Local, WhatOurSearchLeavesEarlyCeresFinishes) {
  int converged = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const Weak weak = make_weak(8, seed);
    const LeastSquaresProblem problem = least_squares(weak);
    LeastSquaresOptions options;
    const LeastSquaresResult floor = minimise_least_squares(problem, Point(8, 0.5), options);
    options.max_evaluations = floor.evaluations / 2;
    const LeastSquaresResult early = minimise_least_squares(problem, Point(8, 0.5), options);
    ASSERT_EQ(early.reason, StopReason::evaluation_limit) << seed;
    LocalOptions local;
    local.ceres = {30, 20, true, 0};
    const LocalResult both = minimise_locally(problem, Point(8, 0.5), options, local);
    EXPECT_EQ(both.search.after, early.cost) << seed;
    EXPECT_GT(both.ceres.steps, 0) << seed;
    EXPECT_LT(both.end.cost, early.cost) << seed;
    EXPECT_EQ(both.refinement.after, both.end.cost) << seed;
    converged += both.end.reason == StopReason::converged && both.end.cost < 1.0001 * floor.cost;
  }
  EXPECT_GE(converged, 5);  // of 6: Ceres finishes it, and says so
}

TEST(Local, NoStageEndsAboveTheOneBefore) {
  for (const int n : {5, 12}) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      const Weak weak = make_weak(n, seed);
      for (const int iterations : {1, 2, 4, 8}) {
        LeastSquaresOptions options;
        options.max_iterations = iterations;
        LocalOptions local;
        local.rescue_evaluations = 40;
        const LocalResult r = minimise_locally(least_squares(weak), Point(n, 0.5), options, local);
        EXPECT_LE(r.search.after, r.search.before);
        EXPECT_LE(r.refinement.after, r.search.after);
        EXPECT_LE(r.rescue.after, r.refinement.after);
        EXPECT_EQ(r.end.cost, r.rescue.after);
      }
    }
  }
}

TEST(Local, BothTogetherTakeNoMoreJacobiansThanTheLimit) {
  const Weak weak = make_weak(8, 2);
  for (const int iterations : {2, 3, 6}) {
    LeastSquaresOptions options;
    options.max_iterations = iterations;
    const LocalResult r = minimise_locally(least_squares(weak), Point(8, 0.5), options);
    EXPECT_LE(r.end.iterations, iterations);
    EXPECT_EQ(r.search.jacobians + r.refinement.jacobians, r.end.iterations);
    EXPECT_EQ(r.search.simulations + r.refinement.simulations, r.end.evaluations);
  }
}

// A bowl under ripples shorter than a difference: it sees their size alone.
LeastSquaresProblem rippled() {
  return {2,
          [](std::span<const Point> points) {
            std::vector<Evaluation> out;
            for (const Point& p : points) {
              Eigen::VectorXd r(3);
              for (int i = 0; i < 2; ++i) r[i] = p[i] - 0.6 + 2e-3 * std::sin(3e6 * p[i]);
              r[2] = 0.1;  // what no fit removes
              out.push_back({true, r});
            }
            return out;
          },
          {}};
}

TEST(Local, WhereDerivativesBreakTheirPromiseBobyqaGoesOn) {
  LocalOptions local;
  const LocalResult without = minimise_locally(rippled(), {0.1, 0.9}, {}, local);
  EXPECT_EQ(without.distrust, Distrust::none);
  local.rescue_evaluations = 200;
  const LocalResult with = minimise_locally(rippled(), {0.1, 0.9}, {}, local);
  EXPECT_EQ(with.distrust, Distrust::broken_promise);
  EXPECT_LT(with.end.cost, 0.5 * without.end.cost);
  EXPECT_GT(with.rescue.simulations, 0);
  EXPECT_LE(with.rescue.simulations, 200);
  EXPECT_EQ(with.end.stop.count, with.rescue.simulations);
  EXPECT_EQ(with.end.stop.at, figures_of(with.end)) << "where BOBYQA has led, not where our search stopped";
}

TEST(Local, ABrokenPromiseOfLittleIsNoProofOfFalseDerivatives) {
  LocalOptions local;
  local.rescue_evaluations = 200;
  const LeastSquaresResult end = minimise_locally(rippled(), {0.1, 0.9}, {}, {}).end;
  const double promised = end.promised_gain / end.cost;
  local.trusted_if_less = 0.5 * promised;
  EXPECT_EQ(minimise_locally(rippled(), {0.1, 0.9}, {}, local).distrust, Distrust::broken_promise);
  local.trusted_if_less = 2 * promised;
  const LocalResult trusted = minimise_locally(rippled(), {0.1, 0.9}, {}, local);
  EXPECT_EQ(trusted.distrust, Distrust::none);
  EXPECT_EQ(trusted.rescue.simulations, 0);
}

TEST(Local, WhereColumnsAreMissingBobyqaGoesOn) {
  // x1 can be had at a few points only: both differences beside it fail.
  const LeastSquaresProblem problem{2,
                                    [](std::span<const Point> points) {
                                      std::vector<Evaluation> out;
                                      for (const Point& p : points) {
                                        const double off = std::abs(p[1] - 0.5);
                                        const bool ok = off == 0 || off > 1e-4;
                                        const Eigen::Vector2d r(p[0] - 0.3, p[1] - 0.8);
                                        out.push_back({ok, ok ? Eigen::VectorXd(r) : Eigen::VectorXd()});
                                      }
                                      return out;
                                    },
                                    {}};
  LocalOptions local;
  local.rescue_evaluations = 200;
  const LocalResult r = minimise_locally(problem, {0.5, 0.5}, {}, local);
  EXPECT_EQ(r.distrust, Distrust::missing_columns);
  EXPECT_NEAR(r.end.point[1], 0.8, 1e-2);
}

TEST(Local, TrustedDerivativesAreLeftAlone) {
  LocalOptions local;
  local.rescue_evaluations = 200;
  const Weak weak = make_weak(6, 1);
  const LocalResult r = minimise_locally(least_squares(weak), Point(6, 0.5), {}, local);
  EXPECT_EQ(r.distrust, Distrust::none);
  EXPECT_EQ(r.rescue.simulations, 0);
}

TEST(Local, SameBitsForAnyNumberOfThreads) {
  const Weak weak = make_weak(8, 2);
  const auto run = [&](int threads) {
    LeastSquaresProblem problem;
    problem.n = 8;
    problem.evaluate = [&weak, threads](std::span<const Point> points) {
      std::vector<Evaluation> values(points.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
      for (std::size_t k = 0; k < points.size(); ++k) values[k].residual = weak.residual(points[k].data());
      return values;
    };
    LeastSquaresOptions options;
    options.max_iterations = 3;
    return minimise_locally(problem, Point(8, 0.3), options);
  };
  const LocalResult one = run(1), four = run(4);
  EXPECT_GT(one.ceres.steps, 0);
  EXPECT_EQ(one.end.point, four.end.point);
  EXPECT_EQ(one.end.cost, four.end.cost);
}

TEST(Local, AnInterruptedSearchIsLeftWhereItStopped) {
  const Weak weak = make_weak(6, 1);
  LeastSquaresOptions options;
  options.progress = [](const LeastSquaresProgress& now) { return now.iteration < 3; };
  LocalOptions local;
  const LocalResult left = minimise_locally(least_squares(weak), Point(6, 0.5), options, local);
  EXPECT_EQ(left.end.reason, StopReason::interrupted);
  EXPECT_EQ(left.ceres.end, CeresEnd::not_run);
  local.after_interruption = true;
  const LocalResult settled = minimise_locally(least_squares(weak), Point(6, 0.5), options, local);
  EXPECT_NE(settled.ceres.end, CeresEnd::not_run);
  EXPECT_LT(settled.end.cost, left.end.cost);
}

}  // namespace
}  // namespace servodx::test
