// The local stage beside Ceres on the kind of problem a servovalve fit is: effects of a full box from 2400 noise
// standard deviations down to 0.1, columns that look alike, curvature, and a minimum on several walls. Same residuals,
// same differences, same tolerance, every point counted. Ceres gets there too on these smooth algebraic stand-ins; what
// it costs is the count of evaluations, and that its points come one at a time.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include "base/random.h"
#include "optimise/box_least_squares.h"
#include "optimise/unit_cube.h"
#include "weak_problem.h"

namespace servodx::test {
namespace {

struct Outcome {
  double misfit;
  long evaluations;
};

class CeresCost : public ceres::CostFunction {
 public:
  CeresCost(const Weak& weak, long* evaluations) : weak_(weak), evaluations_(evaluations) {
    set_num_residuals(static_cast<int>(weak.data.size()));
    for (int j = 0; j < weak.n; ++j) mutable_parameter_block_sizes()->push_back(1);
  }
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    std::vector<double> x(weak_.n);
    for (int j = 0; j < weak_.n; ++j) x[j] = *blocks[j];
    const Eigen::VectorXd r = weak_.residual(x.data());
    ++*evaluations_;
    Eigen::Map<Eigen::VectorXd>(residuals, r.size()) = r;
    if (!jacobians) return true;
    for (int j = 0; j < weak_.n; ++j) {
      if (!jacobians[j]) continue;
      const double old = x[j], h = old + 1e-5 <= 1 ? 1e-5 : -1e-5;
      x[j] = old + h;
      Eigen::Map<Eigen::VectorXd>(jacobians[j], r.size()) = (weak_.residual(x.data()) - r) / h;
      x[j] = old;
      ++*evaluations_;
    }
    return true;
  }

 private:
  const Weak& weak_;
  long* evaluations_;
};

// hold = false: Ceres' own bounds. hold = true: short solves, parameters at a wall that the gradient pushes into held
// constant between them.
Outcome run_ceres(const Weak& weak, const Point& start, bool hold) {
  Outcome outcome{0, 0};
  std::vector<double> x = start;
  for (int round = 0; round < (hold ? 40 : 1); ++round) {
    ceres::Problem problem;
    std::vector<double*> blocks;
    for (double& v : x) blocks.push_back(&v);
    problem.AddResidualBlock(new CeresCost(weak, &outcome.evaluations), nullptr, blocks);
    for (double* v : blocks) {
      problem.SetParameterLowerBound(v, 0, 0.0);
      problem.SetParameterUpperBound(v, 0, 1.0);
    }
    if (hold) {
      std::vector<double> gradient;
      problem.Evaluate({}, nullptr, nullptr, &gradient, nullptr);
      for (int j = 0; j < weak.n; ++j)
        if ((x[j] <= 0 && gradient[j] > 0) || (x[j] >= 1 && gradient[j] < 0))
          problem.SetParameterBlockConstant(blocks[j]);
    }
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = hold ? 5 : 200;
    options.function_tolerance = 1e-8;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    const bool done = summary.termination_type == ceres::CONVERGENCE && summary.num_successful_steps <= 1;
    if (hold && done && round > 0) break;
  }
  outcome.misfit = 0.5 * weak.residual(x.data()).squaredNorm();
  return outcome;
}

Outcome run_ours(const Weak& weak, const Point& start) {
  const LeastSquaresProblem problem = least_squares(weak);
  LeastSquaresOptions options;
  options.compressed_first_pass = true;
  const LeastSquaresResult result = minimise_least_squares(problem, start, options);
  EXPECT_TRUE(result.reason == StopReason::converged);
  return {result.misfit, result.evaluations};
}

TEST(BoxLeastSquares, ReachesTheFloorWithWeakParametersOnTheWallInHalfOfCeresEvaluations) {
  int ours = 0, bounds = 0, held = 0, runs = 0;
  long ours_evaluations = 0, bounds_evaluations = 0, held_evaluations = 0;
  for (const int n : {8, 15, 25}) {
    for (std::uint64_t seed = 1; seed <= 8; ++seed) {
      const Weak weak = make_weak(n, seed);
      Random random(seed, 78);
      Point start(n);
      for (double& v : start) v = random.uniform();
      const Outcome a = run_ours(weak, start), b = run_ceres(weak, start, false), c = run_ceres(weak, start, true);
      const double floor = std::min({a.misfit, b.misfit, c.misfit});
      ++runs;
      ours += a.misfit <= 1.05 * floor;
      bounds += b.misfit <= 1.05 * floor;
      held += c.misfit <= 1.05 * floor;
      ours_evaluations += a.evaluations;
      bounds_evaluations += b.evaluations;
      held_evaluations += c.evaluations;
    }
  }
  std::printf(
      "to 1.05 of the least misfit found, of %d: ours %d (mean %ld evaluations), Ceres' bounds %d (%ld), Ceres held %d "
      "(%ld)\n",
      runs, ours, ours_evaluations / runs, bounds, bounds_evaluations / runs, held, held_evaluations / runs);
  EXPECT_GE(ours, runs - 2);
  EXPECT_GE(ours, bounds);
  EXPECT_GE(ours, held);
  EXPECT_LT(2 * ours_evaluations, bounds_evaluations);
  EXPECT_LT(2 * ours_evaluations, held_evaluations);
}

}  // namespace
}  // namespace servodx::test
