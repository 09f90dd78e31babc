// Decisions.
// - The manifold on one block of n, not n blocks of one: a row of a robust problem then carries one pointer.
// - Normal equations, as in box_least_squares.cpp and for its reasons.
// - The turned rows come of the eigenvectors of J'J, scaled to a unit diagonal: no rank is asked for. Directions below
//   1e-14 of the strongest are left out: of J'J they hold rounding alone.
#include "optimise/ceres_refinement.h"

#include <ceres/ceres.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "optimise/differences.h"
#include "optimise/normal_equations.h"
#include "optimise/robust_loss.h"
#include "optimise/search_stop.h"

namespace servodx {
namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Of Ceres alone. Trials: refused steps shorten the next one by two, four, eight and so on, so four reach a hundredth.
constexpr int trials_a_jacobian = 4;
constexpr int line_search_trials = 5;      // each shortens the bent step to 0.6 at most: five reach a tenth
constexpr double first_tolerance = 1e-3;   // of the first, compressed pass: it only brings the start near
constexpr double least_curvature = 1e-14;  // of the strongest direction's: what is below is rounding

// robust_loss.h's compressed: rho(s) = s / (1 + sqrt(s)/a).
class CompressedLoss final : public ceres::LossFunction {
 public:
  explicit CompressedLoss(double scale) : scale_(scale) {}
  void Evaluate(double s, double rho[3]) const override {
    const double e = std::sqrt(s), u = e / scale_, b = 1 + u;
    rho[0] = s / b;
    rho[1] = (1 + 0.5 * u) / (b * b);
    // The second derivative grows as 1/e towards a corner at zero, where nothing is left to correct.
    rho[2] = u > 1e-12 ? -(3 + u) / (4 * scale_ * e * b * b * b) : 0.0;
  }

 private:
  double scale_;
};

std::unique_ptr<ceres::LossFunction> loss_function(RobustLoss loss, double scale) {
  switch (loss) {
    case RobustLoss::none:
      return nullptr;
    case RobustLoss::soft_l1:
      return std::make_unique<ceres::SoftLOneLoss>(scale);
    case RobustLoss::cauchy:
      return std::make_unique<ceres::CauchyLoss>(scale);
    case RobustLoss::compressed:
      return std::make_unique<CompressedLoss>(scale);
  }
  return nullptr;
}

bool usable(const LeastSquaresProblem& problem, const LeastSquaresResult& end) {
  return end.jacobian.rows() == end.residual.size() && end.jacobian.cols() == problem.n && end.jacobian.allFinite();
}

std::vector<Evaluation> evaluated(const LeastSquaresProblem& problem, const std::vector<Point>& points,
                                  LeastSquaresResult& end, CeresSummary& summary) {
  std::vector<Evaluation> values = problem.evaluate(points);
  if (values.size() != points.size()) throw std::logic_error("BatchEvaluate returned another number of points");
  summary.evaluations += static_cast<long>(points.size());
  end.evaluations += static_cast<long>(points.size());
  for (Evaluation& value : values) {
    const bool alike = end.residual.size() == 0 || value.residual.size() == end.residual.size();
    value.ok = value.ok && alike && value.residual.allFinite();
    end.failed_evaluations += !value.ok;
  }
  return values;
}

// The Jacobian at the end's point, the caller's or by differences, and what it says.
void linearise(const LeastSquaresProblem& problem, LeastSquaresResult& end, const LeastSquaresOptions& options,
               CeresSummary& summary) {
  ++summary.jacobians;
  ++end.iterations;
  end.missing_columns = 0;
  end.jacobian.resize(end.residual.size(), problem.n);
  if (!problem.jacobian || !problem.jacobian(end.point, end.residual, end.jacobian) || !usable(problem, end)) {
    const EvaluatePoints evaluate = [&](const std::vector<Point>& p) { return evaluated(problem, p, end, summary); };
    const DifferenceStep by{options.difference_step, options.difference != Difference::forward};
    end.missing_columns = take_differences(evaluate, end.point, end.residual, by, end.jacobian);
  }
  take_stock(end, normal_equations(end.jacobian, end.residual, options.loss, options.loss_scale), options);
}

// What Ceres asks for, in one batch: residuals at a trial, the Jacobian where a step was taken. The point that Ceres
// stands at is the end itself.
class Batch final : public ceres::EvaluationCallback {
 public:
  Batch(const LeastSquaresProblem& problem, LeastSquaresResult& end, const LeastSquaresOptions& options,
        const CeresBudget& budget, CeresSummary& summary)
      : x(end.point), problem_(problem), end_(end), options_(options), budget_(budget), summary_(summary) {
    turn();
  }

  void PrepareForEvaluation(bool with_jacobian, bool) override {
    if (x == end_.point) {
      at_ = &end_.residual;
      return;
    }
    if (x != trial_) {
      trial_ = x;
      Evaluation value = std::move(evaluate({trial_}).front());
      trial_ok_ = value.ok;
      trial_residual_ = std::move(value.residual);
    }
    at_ = trial_ok_ ? &trial_residual_ : nullptr;
    if (with_jacobian && trial_ok_) move();
  }

  // Of the last point asked for; null where it failed.
  const Eigen::VectorXd* residual() const { return at_; }
  bool at_end() const { return at_ == &end_.residual; }
  const LeastSquaresResult& end() const { return end_; }
  bool may_linearise() const { return summary_.jacobians < budget_.max_jacobians; }
  // Where Ceres stands, turned: J'J = root' root, J'e = root' along, and what of |e| is across.
  const RowMajor& root() const { return root_; }
  const Eigen::VectorXd& along() const { return along_; }
  double across() const { return across_; }

  Point x;  // Ceres' parameter block

 private:
  std::vector<Evaluation> evaluate(const std::vector<Point>& points) {
    return evaluated(problem_, points, end_, summary_);
  }

  // To the trial, which Ceres has taken.
  void move() {
    NormalEquations equations = learn();
    end_.point = trial_;
    end_.residual.swap(trial_residual_);
    trial_.clear();
    at_ = &end_.residual;
    take_stock(end_, std::move(equations), options_);
    const bool promises = end_.promised_gain > options_.cost_tolerance * end_.cost + options_.cost_floor;
    if (may_linearise() && (promises || !budget_.learns)) {
      linearise();
    } else {
      ++summary_.learnt;
    }
    turn();
  }

  // The Jacobian after the step: right along it, as it was across it.
  NormalEquations learn() {
    Eigen::VectorXd step(problem_.n);
    for (int j = 0; j < problem_.n; ++j) step[j] = trial_[j] - end_.point[j];
    const Eigen::VectorXd missed = trial_residual_ - end_.residual - end_.jacobian * step;
    const Eigen::VectorXd way = step / step.squaredNorm();
    const Eigen::VectorXd turned = end_.jacobian.transpose() * missed;
    end_.jacobian.noalias() += missed * way.transpose();
    if (options_.loss != RobustLoss::none)
      return normal_equations(end_.jacobian, trial_residual_, options_.loss, options_.loss_scale);
    NormalEquations out{std::move(end_.normal), end_.jacobian.transpose() * trial_residual_};
    out.matrix += turned * way.transpose() + way * turned.transpose();
    out.matrix += missed.squaredNorm() * way * way.transpose();
    return out;
  }

  void linearise() { servodx::linearise(problem_, end_, options_, summary_); }

  void turn() {
    if (options_.loss != RobustLoss::none) return;
    const int n = problem_.n;
    const double strongest = std::max(end_.normal.diagonal().maxCoeff(), std::numeric_limits<double>::min());
    Eigen::VectorXd scale(n);
    for (int j = 0; j < n; ++j) scale[j] = std::sqrt(std::max(end_.normal(j, j), 1e-24 * strongest));
    const Eigen::VectorXd inverse = scale.cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(inverse.asDiagonal() * end_.normal *
                                                              inverse.asDiagonal());
    const double most = axes.eigenvalues().maxCoeff();
    root_.resize(n, n);
    along_.resize(n);
    for (int k = 0; k < n; ++k) {
      const double curvature = axes.eigenvalues()[k];
      const double length = curvature > least_curvature * most ? std::sqrt(curvature) : 0.0;
      root_.row(k) = length * axes.eigenvectors().col(k).cwiseProduct(scale).transpose();
      along_[k] = length > 0 ? axes.eigenvectors().col(k).cwiseProduct(inverse).dot(end_.gradient) / length : 0.0;
    }
    across_ = std::sqrt(std::max(0.0, end_.residual.squaredNorm() - along_.squaredNorm()));
  }

  const LeastSquaresProblem& problem_;
  LeastSquaresResult& end_;
  const LeastSquaresOptions& options_;
  const CeresBudget& budget_;
  CeresSummary& summary_;
  const Eigen::VectorXd* at_ = nullptr;
  Point trial_;
  Eigen::VectorXd trial_residual_;
  bool trial_ok_ = false;
  RowMajor root_;
  Eigen::VectorXd along_;
  double across_ = 0;
};

// All rows, turned.
class TurnedRows final : public ceres::CostFunction {
 public:
  TurnedRows(const Batch& batch, int n) : batch_(batch), n_(n) {
    set_num_residuals(n + 1);
    mutable_parameter_block_sizes()->push_back(n);
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd* at = batch_.residual();
    if (!at) return false;
    Eigen::Map<Eigen::VectorXd> out(residuals, n_ + 1);
    out.setZero();
    out[n_] = at->norm();
    if (!batch_.at_end()) return true;
    out.head(n_) = batch_.along();
    out[n_] = batch_.across();
    if (!jacobians || !jacobians[0]) return true;
    Eigen::Map<RowMajor> j(jacobians[0], n_ + 1, n_);
    j.topRows(n_) = batch_.root();
    j.row(n_).setZero();
    return true;
  }

 private:
  const Batch& batch_;
  int n_;
};

class OneRow final : public ceres::CostFunction {
 public:
  OneRow(const Batch& batch, int n, Eigen::Index row) : batch_(batch), row_(row) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->push_back(n);
  }
  bool Evaluate(double const* const*, double* residuals, double** jacobians) const override {
    const Eigen::VectorXd* at = batch_.residual();
    if (!at) return false;
    residuals[0] = (*at)[row_];
    if (jacobians && jacobians[0])
      Eigen::Map<Eigen::RowVectorXd>(jacobians[0], batch_.end().jacobian.cols()) = batch_.end().jacobian.row(row_);
    return true;
  }

 private:
  const Batch& batch_;
  Eigen::Index row_;
};

// After each step: whether the solve ends, as a coordinate has met its wall or as no derivatives are to be had.
class Watch final : public ceres::IterationCallback {
 public:
  Watch(const Batch& batch, const LeastSquaresOptions& options, const CeresBudget& budget, CeresSummary& summary)
      : batch_(batch), options_(options), budget_(budget), summary_(summary) {}

  void begin(std::vector<int> held) {
    held_ = std::move(held);
    met_wall = out_of_jacobians = false;
  }

  ceres::CallbackReturnType operator()(const ceres::IterationSummary& now) override {
    const LeastSquaresResult& end = batch_.end();
    if (options_.progress &&
        !options_.progress({end.iterations, end.evaluations, end.cost, end.projected_gradient, &end.point}))
      return ceres::SOLVER_ABORT;
    if (now.iteration == 0) return ceres::SOLVER_CONTINUE;
    (now.step_is_successful ? summary_.steps : summary_.refused) += 1;
    if (!now.step_is_successful) return ceres::SOLVER_CONTINUE;
    for (std::size_t j = 0; j < end.wall.size(); ++j) met_wall = met_wall || (end.wall[j] != 0 && held_[j] == 0);
    out_of_jacobians = !budget_.learns && !batch_.may_linearise();
    return met_wall || out_of_jacobians ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

  bool met_wall = false, out_of_jacobians = false;

 private:
  const Batch& batch_;
  const LeastSquaresOptions& options_;
  const CeresBudget& budget_;
  CeresSummary& summary_;
  std::vector<int> held_;
};

void add_rows(ceres::Problem& problem, Batch& batch, const LeastSquaresOptions& options) {
  const auto n = static_cast<int>(batch.x.size());
  if (options.loss == RobustLoss::none) {
    problem.AddResidualBlock(new TurnedRows(batch, n), nullptr, batch.x.data());
    return;
  }
  for (Eigen::Index row = 0; row < batch.end().residual.size(); ++row)
    problem.AddResidualBlock(new OneRow(batch, n, row), loss_function(options.loss, options.loss_scale).release(),
                             batch.x.data());
}

ceres::Solver::Options solver_options(const LeastSquaresOptions& options, const CeresBudget& budget, int steps,
                                      Watch& watch) {
  ceres::Solver::Options o;
  o.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  o.dense_linear_algebra_library_type = ceres::EIGEN;  // one arithmetic, whatever LAPACK is installed
  o.num_threads = 1;
  o.logging_type = ceres::SILENT;
  o.max_num_iterations = steps;
  o.max_num_line_search_step_size_iterations = budget.line_search_trials;
  o.function_tolerance = options.cost_tolerance;
  o.parameter_tolerance = options.step_tolerance;
  // Only an exact zero: the gradient's size is that of the caller's residuals. The tolerance on the cost decides.
  o.gradient_tolerance = std::numeric_limits<double>::min();
  o.callbacks.push_back(&watch);
  return o;
}

CeresEnd end_of(const ceres::Solver::Summary& summary, const Watch& watch) {
  switch (summary.termination_type) {
    case ceres::CONVERGENCE:
      return CeresEnd::converged;
    case ceres::NO_CONVERGENCE:
      return CeresEnd::no_convergence;
    case ceres::USER_SUCCESS:
      return watch.met_wall || watch.out_of_jacobians ? CeresEnd::no_convergence : CeresEnd::converged;
    case ceres::USER_FAILURE:
      return CeresEnd::interrupted;
    case ceres::FAILURE:
      return CeresEnd::failure;
  }
  return CeresEnd::failure;
}

// One set of held walls.
CeresEnd solve(Batch& batch, const LeastSquaresOptions& options, const CeresBudget& budget, int steps, Watch& watch) {
  const std::vector<int> walls = batch.end().wall;
  const auto n = static_cast<int>(batch.x.size());
  std::vector<int> held;
  for (int j = 0; j < n; ++j)
    if (walls[static_cast<std::size_t>(j)] != 0) held.push_back(j);
  if (static_cast<int>(held.size()) == n) return CeresEnd::converged;
  batch.x = batch.end().point;
  ceres::Problem::Options owned;
  owned.evaluation_callback = &batch;
  ceres::Problem problem(owned);
  add_rows(problem, batch, options);
  for (int j = 0; j < n; ++j) {
    problem.SetParameterLowerBound(batch.x.data(), j, 0.0);
    problem.SetParameterUpperBound(batch.x.data(), j, 1.0);
  }
  if (!held.empty()) problem.SetManifold(batch.x.data(), new ceres::SubsetManifold(n, held));
  watch.begin(walls);
  ceres::Solver::Summary summary;
  ceres::Solve(solver_options(options, budget, steps, watch), &problem, &summary);
  return end_of(summary, watch);
}

void add(CeresSummary& all, const CeresSummary& more) {
  all.end = more.end == CeresEnd::not_run ? CeresEnd::no_convergence : more.end;
  all.solves += more.solves;
  all.steps += more.steps;
  all.refused += more.refused;
  all.released += more.released;
  all.jacobians += more.jacobians;
  all.learnt += more.learnt;
  all.evaluations += more.evaluations;
  all.final_cost = more.final_cost;
}

StopReason reason_of(CeresEnd end) {
  switch (end) {
    case CeresEnd::converged:
      return StopReason::converged;
    case CeresEnd::interrupted:
      return StopReason::interrupted;
    case CeresEnd::failure:
      return StopReason::stalled;
    case CeresEnd::not_run:
    case CeresEnd::no_convergence:
      break;
  }
  return StopReason::iteration_limit;
}

SearchStop::How how_of(CeresEnd end) {
  switch (end) {
    case CeresEnd::converged:
      return SearchStop::How::ceres_converged;
    case CeresEnd::interrupted:
      return SearchStop::How::ceres_interrupted;
    case CeresEnd::failure:
      return SearchStop::How::ceres_failure;
    case CeresEnd::no_convergence:
      return SearchStop::How::ceres_no_convergence;
    case CeresEnd::not_run:
      break;
  }
  return SearchStop::How::not_run;
}

int let_go(const std::vector<int>& before, const std::vector<int>& after) {
  int count = 0;
  for (std::size_t j = 0; j < before.size(); ++j) count += before[j] != 0 && after[j] == 0;
  return count;
}

}  // namespace

CeresSummary refine_by_ceres(const LeastSquaresProblem& problem, LeastSquaresResult& end,
                             const LeastSquaresOptions& options, const CeresBudget& budget) {
  CeresSummary summary;
  summary.initial_cost = summary.final_cost = end.cost;
  if (problem.n == 0 || !usable(problem, end) || end.normal.rows() != problem.n) return summary;
  Batch batch(problem, end, options, budget, summary);
  Watch watch(batch, options, budget, summary);
  for (;;) {
    const int left = budget.max_steps - summary.steps - summary.refused;
    if (left <= 0) break;
    const std::vector<int> held = end.wall;
    const int steps = summary.steps;
    summary.end = solve(batch, options, budget, left, watch);
    ++summary.solves;
    const int released = let_go(held, end.wall);
    const bool goes_on = watch.met_wall || (summary.end == CeresEnd::converged && released > 0);
    if (summary.steps == steps || !goes_on || watch.out_of_jacobians || summary.end == CeresEnd::interrupted ||
        summary.end == CeresEnd::failure)
      break;
    summary.released += released;
  }
  summary.final_cost = end.cost;
  return summary;
}

LeastSquaresResult minimise_by_ceres(const LeastSquaresProblem& problem, const Point& start,
                                     const LeastSquaresOptions& options, CeresSummary* told) {
  options.validate();
  CeresSummary summary;
  LeastSquaresResult end;
  end.point = start;
  for (double& v : end.point) v = std::clamp(v, 0.0, 1.0);
  Evaluation first = std::move(evaluated(problem, {end.point}, end, summary).front());
  if (!first.ok) {
    end.cost = end.misfit = end.start_cost = std::numeric_limits<double>::infinity();
    end.stop = stop_of(end.reason, options);
    if (told) *told = summary;
    return end;
  }
  end.residual = std::move(first.residual);
  end.start_cost = robust_cost(end.residual, options.loss, options.loss_scale);
  // One Jacobian shows nothing: then there is no first pass.
  const bool two = options.compressed_first_pass && options.max_iterations > 2;
  for (int pass = two ? 0 : 1; pass < 2; ++pass) {
    LeastSquaresOptions now = options;
    if (pass == 0) now.loss = RobustLoss::compressed, now.loss_scale = 3.0, now.cost_tolerance = first_tolerance;
    linearise(problem, end, now, summary);
    // Half of the Jacobians at most for the pass that only brings the start near.
    const int left = std::max(0, (pass == 0 ? options.max_iterations / 2 : options.max_iterations) - end.iterations);
    add(summary, refine_by_ceres(problem, end, now, {trials_a_jacobian * left, left, false, line_search_trials}));
    if (summary.end == CeresEnd::interrupted) break;
  }
  end.reason = reason_of(summary.end);
  end.stop = {how_of(summary.end), 0, figures_of(end)};
  summary.initial_cost = end.start_cost;
  if (told) *told = summary;
  return end;
}

}  // namespace servodx
