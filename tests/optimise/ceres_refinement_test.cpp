// Ceres as a fit's local refinement: what it reaches, what it holds, what it says.
#include "optimise/ceres_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/random.h"
#include "functions.h"
#include "nist_problems.h"
#include "optimise/box_least_squares.h"
#include "optimise/normal_equations.h"
#include "optimise/robust_loss.h"
#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"
#include "weak_problem.h"

namespace servodx::test {
namespace {

// An end as our search would leave it, at any point.
LeastSquaresResult end_at(const LeastSquaresProblem& problem, const Point& x, const LeastSquaresOptions& options) {
  LeastSquaresOptions one = options;
  one.max_iterations = 1;
  return minimise_least_squares(problem, x, one);
}

constexpr CeresBudget ample{200, 100, false, 0};

TEST(CeresRefinement, AloneReachesTheCertifiedAnswersFromTheNearStart) {
  LeastSquaresOptions options;
  options.max_iterations = 500;
  options.difference_step = 1e-6;
  options.cost_tolerance = 1e-14;
  for (const NistProblem& nist : nist_problems()) {
    CeresSummary said;
    const LeastSquaresResult end = minimise_by_ceres(least_squares(nist), to_cube(nist, nist.start2), options, &said);
    const std::vector<double> b = from_cube(nist, end.point);
    for (std::size_t j = 0; j < b.size(); ++j) EXPECT_NEAR(b[j] / nist.certified[j], 1, 1e-4) << nist.name;
    EXPECT_EQ(said.final_cost, end.cost) << nist.name;
    EXPECT_EQ(end.stop.how == SearchStop::How::ceres_converged, said.end == CeresEnd::converged) << nist.name;
    EXPECT_EQ(end.stop.at, figures_of(end)) << nist.name;
    EXPECT_LT(said.final_cost, said.initial_cost) << nist.name;
  }
}

TEST(CeresRefinement, EndsWhereOurSearchEndsWithWallsInTheWay) {
  for (const int n : {4, 8}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Weak weak = make_weak(n, seed);
      const LeastSquaresProblem problem = least_squares(weak);
      LeastSquaresOptions options;
      options.cost_tolerance = 1e-12;
      const LeastSquaresResult ours = minimise_least_squares(problem, Point(n, 0.5), options);
      LeastSquaresResult end = ours;  // from beside it: inside, off every wall
      for (double& x : end.point) x = std::clamp(x, 0.02, 0.98);
      end = end_at(problem, end.point, options);
      const CeresSummary said = refine_by_ceres(problem, end, options, ample);
      EXPECT_EQ(said.end, CeresEnd::converged) << n << " " << seed;
      EXPECT_NEAR(end.cost, ours.cost, 1e-6 * ours.cost) << n << " " << seed;
      EXPECT_EQ(end.wall, ours.wall) << n << " " << seed;
      for (std::size_t j = 0; j < end.point.size(); ++j)
        EXPECT_EQ(end.point[j] == 0.0 || end.point[j] == 1.0, end.wall[j] != 0) << n << " " << seed;
    }
  }
}

// x0 begins on its wall and is pushed into it until x1 has moved: then its multiplier has the other sign.
TEST(CeresRefinement, AWallIsLetGoWhereItsMultiplierSaysSo) {
  const LeastSquaresProblem problem{2,
                                    [](std::span<const Point> points) {
                                      std::vector<Evaluation> out;
                                      for (const Point& p : points)
                                        out.push_back({true, Eigen::Vector2d(p[0] + 2 * p[1] - 1.0, p[1] - 0.3)});
                                      return out;
                                    },
                                    {}};
  const LeastSquaresOptions options;
  LeastSquaresResult end = end_at(problem, {0.0, 0.9}, options);
  ASSERT_EQ(end.wall, (std::vector<int>{-1, 0}));
  const CeresSummary said = refine_by_ceres(problem, end, options, ample);
  EXPECT_EQ(said.released, 1);
  EXPECT_GE(said.solves, 2);
  EXPECT_NEAR(end.point[0], 0.4, 1e-4);
  EXPECT_NEAR(end.point[1], 0.3, 1e-4);
  EXPECT_EQ(end.wall, (std::vector<int>{0, 0}));
}

// Along x1 = x0 the cost falls to a corner of the box; a coordinate that met its wall is held there, and the other goes
// on alone.
TEST(CeresRefinement, AWallThatIsMetIsHeldAndTheOthersGoOn) {
  const LeastSquaresProblem problem{2,
                                    [](std::span<const Point> points) {
                                      std::vector<Evaluation> out;
                                      for (const Point& p : points)
                                        out.push_back({true, Eigen::Vector2d(p[0] - 1.5, 10 * (p[1] - 0.5 * p[0]))});
                                      return out;
                                    },
                                    {}};
  const LeastSquaresOptions options;
  LeastSquaresResult end = end_at(problem, {0.2, 0.9}, options);
  const CeresSummary said = refine_by_ceres(problem, end, options, ample);
  EXPECT_EQ(end.point[0], 1.0);
  EXPECT_NEAR(end.point[1], 0.5, 1e-4);
  EXPECT_EQ(end.wall, (std::vector<int>{1, 0}));
  EXPECT_EQ(said.end, CeresEnd::converged);
}

TEST(CeresRefinement, AConvergedEndKeepsItsBitsForOneEvaluation) {
  const Weak weak = make_weak(6, 3);
  const LeastSquaresProblem problem = least_squares(weak);
  const LeastSquaresResult ours = minimise_least_squares(problem, Point(6, 0.4));
  ASSERT_EQ(ours.reason, StopReason::converged);
  LeastSquaresResult end = ours;
  const CeresSummary said = refine_by_ceres(problem, end, {});
  EXPECT_EQ(said.end, CeresEnd::converged);
  EXPECT_EQ(said.evaluations, 1);
  EXPECT_EQ(said.jacobians, 0);
  EXPECT_EQ(end.point, ours.point);
  EXPECT_EQ(end.residual, ours.residual);
}

// A straight valley: what the step teaches is all that there is to learn, and no second Jacobian is taken.
TEST(CeresRefinement, NoJacobianIsTakenWhereTheLastOnePromisesNoMore) {
  Random random(5, 1);
  Eigen::MatrixXd a(30, 5);
  for (double& v : a.reshaped()) v = random.normal();
  const LeastSquaresProblem problem{5,
                                    [a](std::span<const Point> points) {
                                      std::vector<Evaluation> out;
                                      for (const Point& p : points)
                                        out.push_back({true, a * (as_vector(p) - Eigen::VectorXd::Constant(5, 0.4))});
                                      for (Evaluation& e : out) e.residual.array() += 1.0;
                                      return out;
                                    },
                                    {}};
  LeastSquaresOptions options;
  options.step_limit = 1;
  options.cost_tolerance = 1e-6;
  LeastSquaresResult end = end_at(problem, Point(5, 0.6), options);
  const double before = end.promised_gain;
  const CeresSummary said = refine_by_ceres(problem, end, options);
  EXPECT_EQ(said.jacobians, 0);
  EXPECT_EQ(said.learnt, 1);
  EXPECT_EQ(said.steps, 1);
  EXPECT_NEAR(said.initial_cost - said.final_cost, before, 1e-3 * before);
  const NormalEquations anew = normal_equations(end.jacobian, end.residual, RobustLoss::none, 1);
  EXPECT_LT((end.normal - anew.matrix).norm(), 1e-9 * anew.matrix.norm());
}

TEST(CeresRefinement, EachLossIsTheOneOfOurSearch) {
  Random random(9, 1);
  Eigen::MatrixXd a(60, 3);
  for (double& v : a.reshaped()) v = random.normal();
  Eigen::VectorXd b = a * Eigen::Vector3d(0.3, 0.6, 0.5);
  for (Eigen::Index i = 0; i < b.size(); ++i) b[i] += i % 10 == 0 ? 8.0 : 0.1 * random.normal();
  const LeastSquaresProblem problem{3,
                                    [a, b](std::span<const Point> points) {
                                      std::vector<Evaluation> out;
                                      for (const Point& p : points) out.push_back({true, a * as_vector(p) - b});
                                      return out;
                                    },
                                    {}};
  for (const RobustLoss loss : {RobustLoss::none, RobustLoss::soft_l1, RobustLoss::cauchy, RobustLoss::compressed}) {
    LeastSquaresOptions options;
    options.loss = loss;
    options.loss_scale = 0.5;
    options.cost_tolerance = 1e-12;
    const LeastSquaresResult ours = minimise_least_squares(problem, {0.5, 0.5, 0.5}, options);
    CeresSummary said;
    const LeastSquaresResult its = minimise_by_ceres(problem, {0.5, 0.5, 0.5}, options, &said);
    EXPECT_EQ(said.end, CeresEnd::converged) << static_cast<int>(loss);
    EXPECT_NEAR(its.cost, ours.cost, 1e-8 * ours.cost) << static_cast<int>(loss);
    EXPECT_EQ(said.final_cost, robust_cost(its.residual, loss, 0.5)) << static_cast<int>(loss);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(its.point[j], ours.point[j], 1e-4) << static_cast<int>(loss);
  }
}

TEST(CeresRefinement, AloneItKeepsJacobiansForTheLossThatWasAskedFor) {
  const Weak weak = make_weak(6, 3);
  for (const int iterations : {1, 3, 6}) {
    LeastSquaresOptions options;
    options.compressed_first_pass = true;
    options.max_iterations = iterations;
    CeresSummary said;
    const LeastSquaresResult end = minimise_by_ceres(least_squares(weak), Point(6, 0.4), options, &said);
    EXPECT_NE(said.end, CeresEnd::not_run) << iterations;
    EXPECT_LE(end.iterations, iterations);
    EXPECT_EQ(end.iterations, said.jacobians);
    EXPECT_EQ(said.final_cost, 0.5 * end.residual.squaredNorm());
  }
}

// A loss that begins far outside the residuals is none: row by row Ceres then sees what it sees turned.
TEST(CeresRefinement, TurnedRowsAreTheRowsToCeres) {
  const Weak weak = make_weak(7, 4);
  const LeastSquaresProblem problem = least_squares(weak);
  LeastSquaresOptions options;
  options.max_iterations = 4;
  const LeastSquaresResult turned = minimise_by_ceres(problem, Point(7, 0.4), options);
  options.loss = RobustLoss::compressed;
  options.loss_scale = 1e12;
  const LeastSquaresResult row_by_row = minimise_by_ceres(problem, Point(7, 0.4), options);
  for (std::size_t j = 0; j < 7; ++j) EXPECT_NEAR(turned.point[j], row_by_row.point[j], 1e-6) << j;
}

TEST(CeresRefinement, AFailedTrialIsRefusedAndTheEndStays) {
  const LeastSquaresProblem problem{
      1,
      [](std::span<const Point> points) {
        std::vector<Evaluation> out;
        for (const Point& p : points) {
          const bool ok = p[0] < 0.41;
          out.push_back({ok, ok ? Eigen::VectorXd::Constant(1, p[0] - 0.9) : Eigen::VectorXd()});
        }
        return out;
      },
      {}};
  LeastSquaresResult end = end_at(problem, {0.4}, {});
  const LeastSquaresResult before = end;
  const CeresSummary said = refine_by_ceres(problem, end, {});
  EXPECT_EQ(said.refused, 3);
  EXPECT_EQ(end.point, before.point);
  EXPECT_EQ(end.cost, before.cost);
}

}  // namespace
}  // namespace servodx::test
