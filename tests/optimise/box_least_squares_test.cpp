// Laws of the local stage: the conditions of Karush, Kuhn and Tucker at its end, and what it does when evaluations
// fail.
#include "optimise/box_least_squares.h"

#include <gtest/gtest.h>
#include <omp.h>

#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "functions.h"
#include "optimise/box_quadratic.h"
#include "optimise/robust_loss.h"
#include "optimise/search_stop.h"
#include "optimise/unit_cube.h"
#include "weak_problem.h"

namespace servodx::test {
namespace {

Eigen::VectorXd gaussian(int rows, Random& random) {
  Eigen::VectorXd v(rows);
  for (double& x : v) x = random.normal();
  return v;
}

// Every combination of lower wall, free, upper wall; the feasible one of least cost is the answer.
Eigen::VectorXd enumerate_box(const Eigen::MatrixXd& a, const Eigen::VectorXd& g, const Eigen::VectorXd& lower,
                              const Eigen::VectorXd& upper) {
  const int n = static_cast<int>(g.size());
  int combinations = 1;
  for (int j = 0; j < n; ++j) combinations *= 3;
  Eigen::VectorXd best;
  double least = std::numeric_limits<double>::infinity();
  for (int c = 0; c < combinations; ++c) {
    Eigen::VectorXd s = Eigen::VectorXd::Zero(n);
    std::vector<int> open, held;
    for (int j = 0, rest = c; j < n; ++j, rest /= 3) {
      (rest % 3 == 1 ? open : held).push_back(j);
      if (rest % 3 == 0) s[j] = lower[j];
      if (rest % 3 == 2) s[j] = upper[j];
    }
    if (!open.empty()) {
      const Eigen::VectorXd rhs = -g(open) - a(open, held) * s(held);
      const Eigen::MatrixXd inner = a(open, open);
      const Eigen::VectorXd solved = inner.ldlt().solve(rhs);
      s(open) = solved;
    }
    if ((s.array() < lower.array() - 1e-12).any() || (s.array() > upper.array() + 1e-12).any()) continue;
    const double value = 0.5 * s.dot(a * s) + g.dot(s);
    if (value < least) {
      least = value;
      best = s;
    }
  }
  return best;
}

TEST(BoxQuadratic, EqualsTheEnumeratedAnswer) {
  int walls = 0;
  for (std::uint32_t seed = 0; seed < 100; ++seed) {
    Random random(3, seed);
    const int n = 2 + static_cast<int>(random.below(5));
    Eigen::MatrixXd j(2 * n, n);
    for (int k = 0; k < n; ++k) j.col(k) = gaussian(2 * n, random) * std::pow(10, random.uniform(-2, 2));
    const Eigen::MatrixXd a = j.transpose() * j;
    const Eigen::VectorXd g = j.transpose() * (3 * gaussian(2 * n, random));
    Eigen::VectorXd lower(n), upper(n);
    for (int k = 0; k < n; ++k) {
      lower[k] = random.uniform() < 0.2 ? 0 : -random.uniform();
      upper[k] = random.uniform() < 0.2 ? 0 : random.uniform();
    }
    const BoxQuadraticResult result = minimise_box_quadratic(a, g, lower, upper);
    const Eigen::VectorXd answer = enumerate_box(a, g, lower, upper);
    EXPECT_TRUE(result.exact);
    EXPECT_LT((result.step - answer).cwiseAbs().maxCoeff(), 1e-8) << seed;
    for (int wall : result.wall) walls += wall != 0;
  }
  EXPECT_GT(walls, 100);
}

LeastSquaresProblem linear(const Eigen::MatrixXd& a, const Eigen::VectorXd& b) {
  LeastSquaresProblem problem;
  problem.n = static_cast<int>(a.cols());
  problem.evaluate = [a, b](std::span<const Point> points) {
    std::vector<Evaluation> values;
    for (const Point& p : points) values.push_back({true, a * as_vector(p) - b});
    return values;
  };
  return problem;
}

TEST(BoxLeastSquares, OnRandomBoundedLinearProblemsMeetsTheKktConditionsAndTheEnumeratedAnswer) {
  int walls = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    Random random(4, seed);
    const int n = 2 + static_cast<int>(random.below(6)), rows = 3 * n;
    Eigen::MatrixXd a(rows, n);
    for (int k = 0; k < n; ++k) a.col(k) = gaussian(rows, random) * std::pow(10, random.uniform(-1, 2));
    Eigen::VectorXd wanted(n);  // often outside of the box
    for (double& v : wanted) v = random.uniform(-0.7, 1.7);
    const Eigen::VectorXd b = a * wanted + 0.1 * gaussian(rows, random);
    Point start(n);
    for (double& v : start) v = random.uniform();
    LeastSquaresOptions options;
    options.cost_tolerance = 1e-13;
    const LeastSquaresResult result = minimise_least_squares(linear(a, b), start, options);
    EXPECT_EQ(result.reason, StopReason::converged);
    EXPECT_LT(result.gradient_cosine, 1e-5);
    for (int j = 0; j < n; ++j) {
      // Held or free, what is left of the gradient does not point out of a wall by more than is reported.
      const double inward = result.point[j] == 0.0   ? -result.gradient[j]
                            : result.point[j] == 1.0 ? result.gradient[j]
                                                     : 0;
      EXPECT_LE(inward, result.projected_gradient);
      if (result.wall[j] == 0) continue;
      ++walls;
      EXPECT_EQ(result.point[j], result.wall[j] < 0 ? 0.0 : 1.0);
      EXPECT_GE(-result.wall[j] * result.gradient[j], 0) << "the multiplier has the wrong sign";
    }
    const Eigen::VectorXd answer =
        enumerate_box(a.transpose() * a, -a.transpose() * b, Eigen::VectorXd::Zero(n), Eigen::VectorXd::Ones(n));
    EXPECT_NEAR(result.cost, 0.5 * (a * answer - b).squaredNorm(), 1e-9 * result.cost + 1e-12);
    EXPECT_LT((result.jacobian - a).cwiseAbs().maxCoeff(), 1e-5 * a.cwiseAbs().maxCoeff());
  }
  EXPECT_GT(walls, 60);
}

TEST(BoxLeastSquares, EveryLossHasTheGradientOfItsCost) {
  for (const RobustLoss loss : {RobustLoss::none, RobustLoss::soft_l1, RobustLoss::cauchy, RobustLoss::compressed}) {
    for (const double e : {-50.0, -2.0, -1e-3, 1e-8, 0.3, 7.0, 1e4}) {
      const double scale = 1.7, h = 1e-6 * std::abs(e);
      const double slope = (robust(loss, scale, e + h).t - robust(loss, scale, e - h).t) / (2 * h);
      EXPECT_NEAR(robust(loss, scale, e).dt / slope, 1, 1e-5) << static_cast<int>(loss) << " " << e;
    }
    EXPECT_EQ(robust(loss, 1.0, 0.0).t, 0.0);
    EXPECT_EQ(robust(loss, 1.0, 0.0).dt, 1.0);
  }
}

TEST(BoxLeastSquares, RobustLossesHoldAgainstOutliersThatPullThePlainFitAway) {
  Random random(9);
  const int rows = 400;
  Eigen::MatrixXd a(rows, 2);
  a.col(0).setOnes();
  a.col(1) = Eigen::VectorXd::LinSpaced(rows, -1, 1);
  a *= 20;
  Eigen::VectorXd b = a * Eigen::Vector2d(0.4, 0.6) + gaussian(rows, random);
  for (int i = 0; i < rows; i += 10) b[i] += 60;
  const auto error = [&](RobustLoss loss, bool first_pass) {
    LeastSquaresOptions options;
    options.loss = loss;
    options.compressed_first_pass = first_pass;
    const LeastSquaresResult result = minimise_least_squares(linear(a, b), {0.9, 0.1}, options);
    EXPECT_EQ(result.reason, StopReason::converged);
    EXPECT_NEAR(result.misfit, 0.5 * result.residual.squaredNorm(), 1e-9 * result.misfit);
    return std::hypot(result.point[0] - 0.4, result.point[1] - 0.6);
  };
  EXPECT_GT(error(RobustLoss::none, false), 0.2);
  EXPECT_GT(error(RobustLoss::none, true), 0.2);  // the pass is a way, not another answer
  EXPECT_LT(error(RobustLoss::soft_l1, false), 0.03);
  EXPECT_LT(error(RobustLoss::cauchy, true), 0.02);
}

TEST(BoxLeastSquares, FailedEvaluationsAreCountedAndSurvived) {
  const int n = 6;
  const BatchEvaluate inner = residuals_of(rosenbrock(n));
  long asked = 0, failed = 0;
  LeastSquaresProblem problem;
  problem.n = n;
  problem.evaluate = [&](std::span<const Point> points) {
    std::vector<Evaluation> values = inner(points);
    for (std::size_t k = 0; k < points.size(); ++k) {
      ++asked;
      const bool far = as_vector(points[k]).sum() > 0.79 * n;  // a simulation that breaks down in a corner
      const bool stray = std::fmod(12345 * points[k][0] + 54321 * points[k][3], 1.0) < 0.15;
      if (asked == 1 || (!far && !stray)) continue;
      ++failed;
      if (stray) values[k] = {false, {}};
      if (far) values[k].residual[0] = std::nan("");
    }
    return values;
  };
  LeastSquaresOptions options;
  options.max_iterations = 400;
  const LeastSquaresResult result = minimise_least_squares(problem, Point(n, 0.3), options);
  EXPECT_EQ(result.evaluations, asked);
  EXPECT_EQ(result.failed_evaluations, failed);
  EXPECT_GT(failed, 20);
  EXPECT_LT(result.misfit, 1e-6);
}

TEST(BoxLeastSquares, FailedStartIsSaid) {
  LeastSquaresProblem problem;
  problem.n = 2;
  problem.evaluate = [](std::span<const Point> points) { return std::vector<Evaluation>(points.size(), {false, {}}); };
  const LeastSquaresResult result = minimise_least_squares(problem, {0.5, 0.5});
  EXPECT_EQ(result.reason, StopReason::start_failed);
  EXPECT_EQ(result.failed_evaluations, 1);
  EXPECT_EQ(result.stop, SearchStop{SearchStop::How::start_failed});
}

TEST(BoxLeastSquares, StallOnARoughCostIsSaidWithItsGradient) {
  LeastSquaresProblem problem;
  problem.n = 1;
  problem.evaluate = [](std::span<const Point> points) {
    std::vector<Evaluation> values;
    for (const Point& p : points)  // the slope a difference sees is not the slope a step meets
      values.push_back({true, Eigen::VectorXd::Constant(1, 1 + std::abs(p[0] - 0.5) + 0.01 * (p[0] > 0.5))});
    return values;
  };
  const LeastSquaresResult result = minimise_least_squares(problem, {0.5});
  EXPECT_EQ(result.reason, StopReason::stalled);
  EXPECT_GT(result.promised_gain, 0);
  EXPECT_EQ(result.stop.how, SearchStop::How::stalled);
  EXPECT_EQ(result.stop.at, figures_of(result));
}

TEST(BoxLeastSquares, CallersJacobianSavesItsPoints) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(30, 12);
  LeastSquaresProblem problem = linear(a, a * Eigen::VectorXd::Constant(12, 0.4));
  LeastSquaresOptions options;
  options.secant_steps = 0;
  const LeastSquaresResult by_difference = minimise_least_squares(problem, Point(12, 0.7), options);
  problem.jacobian = [&](const Point&, const Eigen::VectorXd&, Eigen::MatrixXd& jacobian) {
    jacobian = a;
    return true;
  };
  const LeastSquaresResult by_caller = minimise_least_squares(problem, Point(12, 0.7));
  EXPECT_EQ(by_caller.reason, StopReason::converged);
  EXPECT_LT(by_caller.evaluations + 24, by_difference.evaluations);
  EXPECT_TRUE(by_caller.jacobian == a);
}

// exp(a_i . x) against its values at a known point: curved, with a full Jacobian.
LeastSquaresProblem exponentials(const Eigen::MatrixXd& a, const Eigen::VectorXd& truth) {
  const Eigen::VectorXd measured = (a * truth).array().exp();
  return {static_cast<int>(a.cols()),
          [a, measured](std::span<const Point> points) {
            std::vector<Evaluation> out;
            for (const Point& p : points) {
              const Eigen::VectorXd e = (a * as_vector(p)).array().exp() - measured.array();
              out.push_back({true, e});
            }
            return out;
          },
          {}};
}

TEST(BoxLeastSquares, StepsThatTeachTheJacobianSaveEvaluationsAndEndAtTheSameMinimumWithDifferences) {
  std::srand(5);
  const int n = 20;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(60, n);
  const Eigen::VectorXd truth = Eigen::VectorXd::LinSpaced(n, 0.3, 0.7);
  const LeastSquaresProblem problem = exponentials(a, truth);
  LeastSquaresOptions options;
  options.difference = Difference::forward;
  options.secant_steps = 0;
  const LeastSquaresResult without = minimise_least_squares(problem, Point(n, 0.9), options);
  options.secant_steps = 3;
  const LeastSquaresResult with = minimise_least_squares(problem, Point(n, 0.9), options);
  EXPECT_EQ(with.reason, StopReason::converged);
  EXPECT_LT(5 * with.evaluations, 4 * without.evaluations);
  for (int j = 0; j < n; ++j) EXPECT_NEAR(with.point[j], truth[j], 1e-6);
  const Eigen::VectorXd values = (a * truth).array().exp();
  EXPECT_LT((with.jacobian - values.asDiagonal() * a).cwiseAbs().maxCoeff(),
            1e-3 * with.jacobian.cwiseAbs().maxCoeff());
}

TEST(BoxLeastSquares, AGivenJacobianThatLearnsIsAskedForLessOftenAndIsTheEndsOwn) {
  std::srand(6);
  const int n = 12;
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(40, n);
  LeastSquaresProblem problem = exponentials(a, Eigen::VectorXd::LinSpaced(n, 0.3, 0.7));
  long asked = 0;
  problem.jacobian = [&](const Point& x, const Eigen::VectorXd&, Eigen::MatrixXd& jacobian) {
    ++asked;
    const Eigen::VectorXd values = (a * as_vector(x)).array().exp();
    jacobian = values.asDiagonal() * a;
    return true;
  };
  LeastSquaresOptions options;
  minimise_least_squares(problem, Point(n, 0.9), options);
  const long without = std::exchange(asked, 0);
  options.given_learns = true;
  const LeastSquaresResult with = minimise_least_squares(problem, Point(n, 0.9), options);
  EXPECT_EQ(with.reason, StopReason::converged);
  EXPECT_LT(asked, without);
  const Eigen::VectorXd values = (a * as_vector(with.point)).array().exp();
  EXPECT_LT((with.jacobian - values.asDiagonal() * a).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(BoxLeastSquares, ALeastMetricHoldsWhatIsHardlySeenAndMovesNoMinimum) {
  // Columns a thousandfold apart. Marquardt's diagonal damps both alike; beside it a part m of the strong column's
  // diagonal holds the weak one by 1 + m 10^6 times as much, and the strong one by 1 + m.
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2, 2);
  a(0, 0) = 1.0, a(1, 1) = 1e-3;
  const LeastSquaresProblem problem = linear(a, a * Eigen::Vector2d(0.6, 0.5));
  const Point start = {0.4, 0.3};
  const auto run = [&](double least, int iterations) {
    LeastSquaresOptions o;
    o.damping_trials = 1, o.first_damping = 1e3, o.secant_steps = 0;
    o.least_metric = least;
    o.max_iterations = iterations;
    return minimise_least_squares(problem, start, o).point;
  };
  for (const double least : {0.0, 1e-5, 1e-3}) {
    const Point first = run(least, 2), end = run(least, 100);
    const auto damping = [&](int k) { return 0.2 / (first[k] - start[k]) - 1; };
    EXPECT_NEAR(damping(1) / damping(0), (1 + least * 1e6) / (1 + least), 1e-3 * (1 + least * 1e6)) << least;
    EXPECT_NEAR(end[0], 0.6, 1e-6) << least;
    EXPECT_NEAR(end[1], 0.5, 1e-4) << least;
  }
}

TEST(BoxLeastSquares, InterruptionGoalAndLimitsReturnTheBestSoFar) {
  const LeastSquaresProblem problem{4, residuals_of(rosenbrock(4)), {}};
  LeastSquaresOptions options;
  options.progress = [](const LeastSquaresProgress& now) { return now.iteration < 5; };
  const LeastSquaresResult stopped = minimise_least_squares(problem, Point(4, 0.2), options);
  EXPECT_EQ(stopped.reason, StopReason::interrupted);
  EXPECT_EQ(stopped.iterations, 5);
  options = {};
  options.cost_goal = 1;
  const LeastSquaresResult goal = minimise_least_squares(problem, Point(4, 0.2), options);
  EXPECT_EQ(goal.reason, StopReason::goal);
  EXPECT_LE(goal.misfit, 1);
  options = {};
  options.max_iterations = 2;
  EXPECT_EQ(minimise_least_squares(problem, Point(4, 0.2), options).reason, StopReason::iteration_limit);
  options = {};
  options.max_evaluations = 20;
  EXPECT_EQ(minimise_least_squares(problem, Point(4, 0.2), options).reason, StopReason::evaluation_limit);
}

TEST(BoxLeastSquares, AStopTellsHowWithItsCountAndItsFigures) {
  using How = SearchStop::How;
  const LeastSquaresProblem problem{4, residuals_of(rosenbrock(4)), {}};
  const auto stop = [&](const LeastSquaresOptions& options, const LeastSquaresProblem& of) {
    const LeastSquaresResult end = minimise_least_squares(of, Point(static_cast<std::size_t>(of.n), 0.2), options);
    EXPECT_EQ(end.stop.at, figures_of(end));
    EXPECT_EQ(end.stop.missing_columns, 0);
    return std::pair(end.stop.how, end.stop.count);
  };
  EXPECT_EQ(stop({.max_iterations = 2}, problem), std::pair(How::iteration_limit, 2L));
  EXPECT_EQ(stop({.max_evaluations = 20}, problem), std::pair(How::evaluation_limit, 20L));
  EXPECT_EQ(stop({.cost_goal = 1}, problem), std::pair(How::goal, 0L));
  EXPECT_EQ(stop({.progress = [](const LeastSquaresProgress&) { return false; }}, problem),
            std::pair(How::interrupted, 0L));
  // Of a cost that is nearly all what no point removes an iteration lowers little.
  const LeastSquaresProblem slow{4,
                                 [&](std::span<const Point> points) {
                                   std::vector<Evaluation> out = residuals_of(rosenbrock(4))(points);
                                   for (Evaluation& e : out) {
                                     e.residual.conservativeResize(e.residual.size() + 1);
                                     e.residual[e.residual.size() - 1] = 1e3;
                                   }
                                   return out;
                                 },
                                 {}};
  EXPECT_EQ(stop({.secant_steps = 0, .slow_iterations = 1}, slow), std::pair(How::too_slow, 1L));
}

TEST(BoxLeastSquares, AStallByAJacobianThatLacksColumnsTellsHowMany) {
  // x1 can be had at its start alone, and what is left of the slope leads uphill.
  LeastSquaresProblem problem;
  problem.n = 2;
  problem.evaluate = [](std::span<const Point> points) {
    std::vector<Evaluation> out;
    for (const Point& p : points)
      out.push_back({p[1] == 0.5, Eigen::VectorXd::Constant(1, 1 + std::abs(p[0] - 0.5) + 0.01 * (p[0] > 0.5))});
    return out;
  };
  const LeastSquaresResult end = minimise_least_squares(problem, {0.5, 0.5});
  EXPECT_EQ(end.stop.how, SearchStop::How::stalled);
  EXPECT_EQ(end.stop.missing_columns, 1);
}

TEST(BoxLeastSquares, WrongOptionIsNamed) {
  LeastSquaresOptions options;
  options.step_limit = 2;
  try {
    minimise_least_squares({1, residuals_of(sphere(1)), {}}, {0.5}, options);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("step_limit"), std::string::npos);
  }
}

TEST(BoxLeastSquares, SameBitsForAnyNumberOfThreads) {
  const Function function = rosenbrock(8);
  const auto run = [&](int threads) {
    LeastSquaresProblem problem;
    problem.n = 8;
    problem.evaluate = [&function, threads](std::span<const Point> points) {
      std::vector<Evaluation> values(points.size());
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
      for (std::size_t k = 0; k < points.size(); ++k) values[k].residual = function.residual(as_vector(points[k]));
      return values;
    };
    return minimise_least_squares(problem, Point(8, 0.3));
  };
  const LeastSquaresResult one = run(1), many = run(5);
  EXPECT_EQ(one.point, many.point);
  EXPECT_EQ(one.cost, many.cost);
  EXPECT_EQ(one.evaluations, many.evaluations);
}

TEST(BoxLeastSquares, ALongLogOfFortyParametersStaysModest) {
  Random random(12);
  const int rows = 20'000, n = 40;
  Eigen::MatrixXd a(rows, n);
  for (int k = 0; k < n; ++k) a.col(k) = gaussian(rows, random);
  LeastSquaresProblem problem = linear(a, a * Eigen::VectorXd::Constant(n, 0.3) + gaussian(rows, random));
  const LeastSquaresResult result = minimise_least_squares(problem, Point(n, 0.6));
  EXPECT_EQ(result.reason, StopReason::converged);
  EXPECT_LT(result.evaluations, 400);
}

// A checkpoint keeps the end alone: whatever ended the search, and by whatever differences.
TEST(BoxLeastSquares, AnEndWhoseRowsAreMadeAgainIsTheSearchsOwn) {
  const Weak weak = make_weak(12, 5);
  const LeastSquaresProblem problem = least_squares(weak);
  std::vector<LeastSquaresOptions> all;
  for (const int iterations : {1, 2, 3, 5, 100})
    for (const Difference difference : {Difference::forward, Difference::forward_then_central})
      for (const RobustLoss loss : {RobustLoss::none, RobustLoss::soft_l1})
        for (const bool compressed : {false, true}) {
          LeastSquaresOptions o;
          o.max_iterations = iterations, o.difference = difference, o.loss = loss;
          o.compressed_first_pass = compressed;
          all.push_back(o);
        }
  for (std::size_t k = 0; k < all.size(); ++k) {
    const LeastSquaresResult end = minimise_least_squares(problem, Point(12, 0.4), all[k]);
    long asked = 0;
    LeastSquaresProblem counted = problem;
    counted.evaluate = [&](std::span<const Point> points) {
      asked += static_cast<long>(points.size());
      return problem.evaluate(points);
    };
    const LeastSquaresResult again = with_rows(without_rows(end), counted, all[k]);
    EXPECT_LE(asked, 1 + 2 * 12) << k;
    EXPECT_EQ(again.point, end.point) << k;
    for (const auto figure : {&LeastSquaresResult::start_cost, &LeastSquaresResult::cost, &LeastSquaresResult::misfit,
                              &LeastSquaresResult::projected_gradient, &LeastSquaresResult::gradient_cosine,
                              &LeastSquaresResult::promised_gain})
      EXPECT_EQ(again.*figure, end.*figure) << k;
    EXPECT_EQ(again.residual, end.residual) << k;
    EXPECT_EQ(again.jacobian, end.jacobian) << k;
    EXPECT_EQ(again.normal, end.normal) << k;
    EXPECT_EQ(again.gradient, end.gradient) << k;
    EXPECT_EQ(again.wall, end.wall) << k;
    EXPECT_EQ(again.evaluations, end.evaluations) << k;
    EXPECT_EQ(again.iterations, end.iterations) << k;
    EXPECT_EQ(again.reason, end.reason) << k;
    EXPECT_EQ(again.stop, end.stop) << k;
  }
}

// Derivatives that are wrong: the cost rises whatever the step, and shorter ones promise ever less.
TEST(BoxLeastSquares, NoTrialIsRunThatPromisesLessThanTheTolerance) {
  constexpr double start = 0.5;
  double shortest = 1;
  LeastSquaresProblem problem;
  problem.n = 1;
  problem.evaluate = [&](std::span<const Point> points) {
    std::vector<Evaluation> out;
    for (const Point& x : points) {
      const double step = std::abs(x[0] - start);
      if (step > 0) shortest = std::min(shortest, step);
      out.push_back({true, Eigen::VectorXd::Constant(1, 1 + step)});
    }
    return out;
  };
  problem.jacobian = [](const Point&, const Eigen::VectorXd&, Eigen::MatrixXd& j) {
    j(0, 0) = -1;
    return true;
  };
  LeastSquaresOptions options;
  options.cost_tolerance = 1e-2;
  const LeastSquaresResult end = minimise_least_squares(problem, {start}, options);
  EXPECT_EQ(end.reason, StopReason::stalled);
  EXPECT_EQ(end.point[0], start);
  // Of a cost of 0.5 with a slope of 1.
  EXPECT_GT(shortest, 0.5 * options.cost_tolerance);
  EXPECT_LT(shortest, 0.1) << "some were tried";
}

}  // namespace
}  // namespace servodx::test
