// Decisions.
// - Not Ceres' minimiser from afar; it takes over where this search ends (local.h). It meets bounds by projecting a
//   step that was solved as if free, and it asks for residuals one point at a time, which would leave seven of eight
//   lanes empty. On weakly identified problems with walls (8 to 25 parameters,
//   tests/optimise/ceres_comparison_test.cpp) all three reach the floor in 24 of 24 runs, in a mean of 244 evaluations
//   here, 1779 with Ceres' bounds, 1186 with Ceres and the parameters at walls held constant between short solves. On
//   servovalve traces Ceres' bounds also failed to arrive (3 of 8 runs against 8 of 8).
// - The normal equations are formed block by block and scaled to a unit diagonal before they are factored: a QR of J
//   takes twice the arithmetic, and the digits it saves are below the damping and the noise.
// - Curved valleys: when the best trial yields less than the undamped model promises, every trial is bent by the
//   curvature it met, one more batch. NIST's Misra1a takes 16 Jacobians in place of 58, MGH10 80 in place of 549.
#include "optimise/box_least_squares.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/error.h"
#include "optimise/box_quadratic.h"
#include "optimise/differences.h"
#include "optimise/normal_equations.h"

namespace servodx {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kLeastDamping = 1e-12;
constexpr double kMostDamping = 1e12;
constexpr double kGoodGain = 0.75;    // of what the undamped model promises; below it the trials are bent
constexpr double kKeptPromise = 0.5;  // of what a step promised: its Jacobian serves once more
constexpr double kRounding = 1e-12;   // of the cost: a promised gain below this cannot be seen
constexpr double kSlowShare = 0.9;    // of the cost some iterations ago: a search that is above it is too slow
constexpr double kBendFrom = 1e-6;    // of the box; shorter steps meet rounding, not curvature

void require(bool good, const char* option, const char* rule) {
  if (!good) throw InputError({}, std::string("option '") + option + "' " + rule, "");
}

class Search {
 public:
  Search(const LeastSquaresProblem& problem, const LeastSquaresOptions& options)
      : problem_(problem), options_(options) {}

  // What the normal equations say of an end that is known.
  void take_stock(LeastSquaresResult& end, NormalEquations equations) {
    x_ = end.point;
    cost_ = end.cost;
    const Model m = scaled(std::move(equations));
    end.promised_gain = trial(m, m.gradient, kLeastDamping, options_.step_limit).promised;
    end.gradient = std::move(result_.gradient);
    end.normal = std::move(result_.normal);
    end.wall = std::move(result_.wall);
    end.projected_gradient = result_.projected_gradient;
    end.gradient_cosine = result_.gradient_cosine;
  }

  // The rows of an end that is known; what they say of it as the search had it.
  LeastSquaresResult again(const SearchEnd& end) {
    if (end.reason != StopReason::start_failed) {
      std::vector<Evaluation> at = evaluate({end.point});
      if (!at[0].ok) throw std::logic_error("the end of a search that was kept cannot be evaluated");
      x_ = end.point;
      residual_ = std::move(at[0].residual);
      take_jacobian(end.central);
      loss_ = options_.loss, loss_scale_ = options_.loss_scale;
      cost_ = cost_of(residual_);
      model();
    }
    result_.start_cost = end.start_cost, result_.promised_gain = end.promised_gain;
    result_.iterations = end.iterations;
    result_.reason = end.reason, result_.stop = end.stop;
    LeastSquaresResult out = finish();
    out.point = end.point;
    out.evaluations = end.evaluations, out.failed_evaluations = end.failed_evaluations;
    return out;
  }

  LeastSquaresResult run(const Point& start) {
    if (begin(start)) {
      bool go_on = true;
      if (options_.compressed_first_pass)
        go_on = pass(RobustLoss::compressed, 3.0, std::max(1e-3, options_.cost_tolerance), false);
      if (go_on) pass(options_.loss, options_.loss_scale, options_.cost_tolerance, true);
    }
    return finish();
  }

 private:
  // The normal equations of one point, with the loss of the pass.
  struct Model {
    Eigen::VectorXd metric;    // of the damping, scaled alike
    Eigen::MatrixXd hessian;   // J'J of the changed residual, scaled to a unit diagonal
    Eigen::VectorXd gradient;  // in scaled coordinates
    Eigen::VectorXd scale;     // s = scale * scaled step
  };

  bool usable(const Evaluation& evaluation) const { return evaluation.ok && evaluation.residual.allFinite(); }

  std::vector<Evaluation> evaluate(const std::vector<Point>& points) {
    if (points.empty()) return {};
    std::vector<Evaluation> values = problem_.evaluate(points);
    if (values.size() != points.size()) throw std::logic_error("BatchEvaluate returned another number of points");
    result_.evaluations += static_cast<long>(points.size());
    for (Evaluation& value : values) {
      value.ok = usable(value);
      if (!value.ok) {
        ++result_.failed_evaluations;
      } else if (residual_.size() > 0 && value.residual.size() != residual_.size()) {
        throw std::logic_error("BatchEvaluate returned another number of residuals");
      }
    }
    return values;
  }

  double cost_of(const Eigen::VectorXd& residual) const { return robust_cost(residual, loss_, loss_scale_); }

  bool begin(const Point& start) {
    if (static_cast<int>(start.size()) != problem_.n) throw std::logic_error("start point has the wrong length");
    x_ = start;
    for (double& v : x_) v = std::clamp(v, 0.0, 1.0);
    std::vector<Evaluation> first = evaluate({x_});
    if (!first[0].ok) {
      result_.reason = StopReason::start_failed;
      result_.stop = stop_of(result_.reason, options_);
      return false;
    }
    residual_ = std::move(first[0].residual);
    result_.start_cost = robust_cost(residual_, options_.loss, options_.loss_scale);
    return true;
  }

  void take_jacobian(bool central) {
    result_.central = central;
    if (problem_.jacobian) {
      jacobian_.resize(residual_.size(), problem_.n);
      if (problem_.jacobian(x_, residual_, jacobian_) && jacobian_.rows() == residual_.size() &&
          jacobian_.cols() == problem_.n && jacobian_.allFinite()) {
        own_jacobian_ = false;
        result_.missing_columns = 0;
        blocks_ = row_blocks(jacobian_);
        return;
      }
    }
    own_jacobian_ = true;
    result_.missing_columns = take_differences([this](const std::vector<Point>& points) { return evaluate(points); },
                                               x_, residual_, {options_.difference_step, central}, jacobian_);
    blocks_ = row_blocks(jacobian_);
  }

  Model model() { return scaled(normal_equations(jacobian_, blocks_, residual_, loss_, loss_scale_)); }

  Model scaled(NormalEquations equations) {
    const int n = problem_.n;
    result_.gradient = std::move(equations.gradient);
    result_.normal = std::move(equations.matrix);
    const Eigen::VectorXd& gradient = result_.gradient;
    const Eigen::MatrixXd& hessian = result_.normal;

    Model m;
    const double largest = std::max(hessian.diagonal().maxCoeff(), std::numeric_limits<double>::min());
    m.scale.resize(n);
    for (int j = 0; j < n; ++j) m.scale[j] = 1.0 / std::sqrt(std::max(hessian(j, j), 1e-24 * largest));
    m.metric = 1.0 + options_.least_metric * largest * m.scale.array().square();
    m.hessian = m.scale.asDiagonal() * hessian * m.scale.asDiagonal();
    m.gradient = m.scale.cwiseProduct(gradient);

    result_.wall.assign(n, 0);
    result_.projected_gradient = result_.gradient_cosine = 0;
    const double length = std::sqrt(2 * cost_);
    for (int j = 0; j < n; ++j) {
      if (x_[j] <= 0.0 && gradient[j] >= 0) result_.wall[j] = -1;
      if (x_[j] >= 1.0 && gradient[j] <= 0) result_.wall[j] = +1;
      if (result_.wall[j] != 0) continue;
      result_.projected_gradient = std::max(result_.projected_gradient, std::abs(gradient[j]));
      if (length > 0) result_.gradient_cosine = std::max(result_.gradient_cosine, std::abs(m.gradient[j]) / length);
    }
    return m;
  }

  struct Trial {
    Point point;
    Eigen::VectorXd scaled_step;
    double promised = 0;
    double length = 0;  // largest coordinate move
    double damping = 0;
  };

  Trial trial(const Model& m, const Eigen::VectorXd& gradient, double damping, double radius) const {
    const int n = problem_.n;
    Eigen::VectorXd lower(n), upper(n);
    for (int j = 0; j < n; ++j) {
      lower[j] = std::max(-x_[j], -radius);
      upper[j] = std::min(1.0 - x_[j], radius);
    }
    Eigen::MatrixXd damped = m.hessian;
    damped.diagonal() += damping * m.metric;
    const BoxQuadraticResult step =
        minimise_box_quadratic(damped, gradient, lower.cwiseQuotient(m.scale), upper.cwiseQuotient(m.scale));
    Trial t;
    t.damping = damping;
    t.scaled_step = step.step;
    t.point = x_;
    for (int j = 0; j < n; ++j) {
      const double move = step.wall[j] < 0 ? lower[j] : step.wall[j] > 0 ? upper[j] : step.step[j] * m.scale[j];
      double to = std::clamp(x_[j] + move, 0.0, 1.0);
      if (step.wall[j] < 0 && lower[j] == -x_[j]) to = 0.0;
      if (step.wall[j] > 0 && upper[j] == 1.0 - x_[j]) to = 1.0;
      t.point[j] = to;
      t.length = std::max(t.length, std::abs(to - x_[j]));
    }
    t.promised = std::max(0.0, -(0.5 * step.step.dot(m.hessian * step.step) + m.gradient.dot(step.step)));
    return t;
  }

  // The trial turned by the curvature it met: the same subproblem with the part of the residual that the linear model
  // missed.
  Trial bend(const Model& m, const Trial& from, const Eigen::VectorXd& met, double radius) const {
    Eigen::VectorXd weighted = met;
    if (loss_ != RobustLoss::none) {
      for (Eigen::Index i = 0; i < met.size(); ++i)
        weighted[i] = robust(loss_, loss_scale_, residual_[i]).dt * robust(loss_, loss_scale_, met[i]).t;
    }
    Eigen::VectorXd gradient = m.scale.cwiseProduct(transposed_product(jacobian_, blocks_, weighted));
    gradient -= m.hessian * from.scaled_step;
    return trial(m, gradient, from.damping, radius);
  }

  // Dampings a decade apart from `from` upwards. Steps that hardly differ from the one before are left out.
  std::vector<Trial> ladder(const Model& m, double from, double radius) const {
    std::vector<Trial> trials;
    double damping = std::clamp(from, kLeastDamping, kMostDamping);
    for (int k = 0; k < options_.damping_trials; ++k, damping *= 10) {
      Trial next = trial(m, m.gradient, damping, radius);
      if (!trials.empty()) {
        double apart = 0;
        for (int j = 0; j < problem_.n; ++j) apart = std::max(apart, std::abs(next.point[j] - trials.back().point[j]));
        if (apart <= 0.01 * trials.back().length) {
          trials.back().damping = damping;
          continue;
        }
      }
      if (next.length > 0) trials.push_back(std::move(next));
    }
    return trials;
  }

  enum class Step { accepted, none_better };

  struct Best {
    int index = -1;
    double cost = kInfinity;
  };

  Best choose(const std::vector<Evaluation>& values, Best best) const {
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (!values[k].ok) continue;
      const double cost = cost_of(values[k].residual);
      if (cost < best.cost) best = {static_cast<int>(k), cost};
    }
    return best;
  }

  static std::vector<Point> points_of(const std::vector<Trial>& trials) {
    std::vector<Point> points;
    for (const Trial& t : trials) points.push_back(t.point);
    return points;
  }

  // The Jacobian after a step from (x, residual).
  void learn(const Point& x, const Eigen::VectorXd& residual) {
    Eigen::VectorXd step(problem_.n);
    for (int j = 0; j < problem_.n; ++j) step[j] = x_[j] - x[j];
    learn_step(jacobian_, blocks_, step, residual_ - residual - product(jacobian_, blocks_, step));
  }

  // Raises the damping and shortens the reach until a trial lowers the cost, or none promises more than the tolerance.
  Step step(const Model& m, double tolerance) {
    double from = damping_ * 1e-4;
    double radius = radius_;
    for (;;) {
      std::vector<Trial> trials = ladder(m, from, radius);
      if (trials.empty()) return Step::none_better;
      double shortest = kInfinity, longest = 0, most_damping = 0, promised = 0;
      for (const Trial& t : trials) {
        promised = std::max(promised, t.promised);
        shortest = std::min(shortest, t.length);
        longest = std::max(longest, t.length);
        most_damping = std::max(most_damping, t.damping);
      }
      if (promised <= tolerance * cost_ + options_.cost_floor) return Step::none_better;
      Best best{-1, cost_};
      std::vector<Evaluation> values = evaluate(points_of(trials));
      best = choose(values, best);
      const bool disappoints = best.index < 0 || cost_ - best.cost < kGoodGain * result_.promised_gain;
      if (disappoints && longest > kBendFrom) {
        std::vector<Trial> bent;
        for (std::size_t k = 0; k < trials.size(); ++k)
          if (values[k].ok) bent.push_back(bend(m, trials[k], values[k].residual, radius));
        std::vector<Evaluation> bent_values = evaluate(points_of(bent));
        const Best bent_best = choose(bent_values, {-1, best.cost});
        if (bent_best.index >= 0) {
          best = bent_best;
          trials = std::move(bent);
          values = std::move(bent_values);
        }
      }
      if (best.index >= 0) {
        Trial& t = trials[best.index];
        damping_ = std::clamp(t.damping, kLeastDamping, kMostDamping);
        radius_ = std::min(options_.step_limit, std::max(radius, 4 * t.length));
        x_ = std::move(t.point);
        residual_ = std::move(values[best.index].residual);
        kept_promise_ = cost_ - best.cost >= kKeptPromise * t.promised;
        cost_ = best.cost;
        return Step::accepted;
      }
      if (longest < options_.step_tolerance) return Step::none_better;
      from = most_damping * 10;
      radius = 0.25 * shortest;
    }
  }

  // What a pass carries from step to step.
  struct Pass {
    double tolerance;
    bool central;               // differences of the Jacobian
    bool may_refine;            // central differences are still to be had where it ends
    std::vector<double> costs;  // at each new Jacobian
    int learnt = 0;             // steps that the Jacobian has learnt since its differences
    bool fresh() const { return learnt == 0; }
  };
  enum class Next { step, again, pass_ends, search_ends };

  Next end(Next next, StopReason reason) { return end(next, reason, stop_of(reason, options_)); }

  Next end(Next next, StopReason reason, SearchStop stop) {
    stop.at = {cost_, result_.gradient_cosine, result_.promised_gain};
    result_.reason = reason, result_.stop = stop;
    return next;
  }

  // With central differences once more, where the forward ones say that it is the end.
  bool refine(Pass& pass) {
    if (!pass.may_refine || !own_jacobian_ || pass.central) return false;
    pass.central = true;
    return true;
  }

  // Before a step: whether it is the end, by the caller, by the goal, by the promise or by a limit.
  Next before_step(Pass& pass) {
    if (options_.progress) {
      const LeastSquaresProgress now{result_.iterations, result_.evaluations, cost_, result_.projected_gradient, &x_};
      if (!options_.progress(now)) return end(Next::search_ends, StopReason::interrupted);
    }
    if (options_.cost_goal >= 0 && 0.5 * residual_.squaredNorm() <= options_.cost_goal)
      return end(Next::search_ends, StopReason::goal);
    const bool flat_cost = cost_ <= options_.cost_floor;
    const bool at_end = flat_cost || result_.promised_gain <= pass.tolerance * cost_ + options_.cost_floor;
    if (at_end && !pass.fresh()) {  // only differences say that it is the end
      pass.learnt = 0;
      return Next::again;
    }
    if (at_end) {
      if (!flat_cost && refine(pass)) return Next::again;
      return end(Next::pass_ends, StopReason::converged);
    }
    return pass.fresh() ? within_limits(pass) : Next::step;
  }

  Next within_limits(Pass& pass) {
    if (result_.iterations >= options_.max_iterations) return end(Next::search_ends, StopReason::iteration_limit);
    if (options_.max_evaluations > 0 && result_.evaluations >= options_.max_evaluations)
      return end(Next::search_ends, StopReason::evaluation_limit);
    pass.costs.push_back(cost_);
    const auto slow = static_cast<std::size_t>(options_.slow_iterations);
    if (slow > 0 && pass.costs.size() > slow && cost_ > kSlowShare * pass.costs[pass.costs.size() - 1 - slow])
      return end(Next::search_ends, StopReason::stalled, {SearchStop::How::too_slow, options_.slow_iterations});
    return Next::step;
  }

  // Where no step lowers the cost.
  Next without_step(Pass& pass) {
    if (!pass.fresh()) {
      pass.learnt = 0;
      return Next::again;
    }
    if (refine(pass)) return Next::again;
    if (result_.promised_gain <= kRounding * cost_)
      return end(Next::pass_ends, StopReason::converged, {SearchStop::How::converged_to_rounding});
    SearchStop stalled = stop_of(StopReason::stalled, options_);
    stalled.missing_columns = result_.missing_columns;
    return end(Next::pass_ends, StopReason::stalled, stalled);
  }

  // One loss, to its tolerance. False: the whole search ends here.
  bool pass(RobustLoss loss, double scale, double tolerance, bool last) {
    loss_ = loss;
    loss_scale_ = scale;
    cost_ = cost_of(residual_);
    damping_ = options_.first_damping;
    radius_ = options_.step_limit;
    Pass pass{tolerance,
              options_.difference == Difference::central,
              last && options_.difference == Difference::forward_then_central,
              {}};
    for (;;) {
      if (pass.fresh()) take_jacobian(pass.central);
      const Model m = model();
      result_.promised_gain = trial(m, m.gradient, kLeastDamping, options_.step_limit).promised;
      if (pass.fresh()) ++result_.iterations;
      Next next = before_step(pass);
      if (next == Next::step) {
        const Point x = x_;
        const Eigen::VectorXd residual = residual_;
        if (step(m, pass.tolerance) == Step::accepted) {
          const bool learns = own_jacobian_ || options_.given_learns;
          pass.learnt =
              learns && !pass.central && kept_promise_ && pass.learnt < options_.secant_steps ? pass.learnt + 1 : 0;
          if (pass.learnt > 0) learn(x, residual);
        } else {
          next = without_step(pass);
        }
      }
      if (next == Next::pass_ends) return true;
      if (next == Next::search_ends) return false;
    }
  }

  LeastSquaresResult finish() {
    result_.point = x_;
    if (result_.reason == StopReason::start_failed) {
      result_.cost = result_.misfit = kInfinity;
      return std::move(result_);
    }
    result_.misfit = 0.5 * residual_.squaredNorm();
    loss_ = options_.loss;
    loss_scale_ = options_.loss_scale;
    const double pass_cost = cost_;
    result_.cost = cost_ = cost_of(residual_);
    if (pass_cost != cost_)
      model();  // it ended in the compressed pass: report gradient and walls of the asked-for cost
    result_.residual = std::move(residual_);
    result_.jacobian = std::move(jacobian_);
    return std::move(result_);
  }

  const LeastSquaresProblem& problem_;
  const LeastSquaresOptions& options_;
  LeastSquaresResult result_;
  Point x_;
  Eigen::VectorXd residual_;
  Eigen::MatrixXd jacobian_;
  RowBlocks blocks_;  // of the Jacobian
  RobustLoss loss_ = RobustLoss::none;
  double loss_scale_ = 1;
  double cost_ = kInfinity;
  double damping_ = 0;
  double radius_ = 0;
  bool own_jacobian_ = true;
  bool kept_promise_ = false;  // the last step
};

}  // namespace

void LeastSquaresOptions::validate() const {
  require(max_iterations >= 1, "max_iterations", "must be at least 1");
  require(max_evaluations >= 0, "max_evaluations", "must not be negative (0 means no limit)");
  require(step_limit > 0 && step_limit <= 1, "step_limit", "must be above 0 and at most 1");
  require(difference_step > 0 && difference_step <= 0.1, "difference_step", "must be above 0 and at most 0.1");
  require(damping_trials >= 1 && damping_trials <= 64, "damping_trials", "must be 1 to 64");
  require(secant_steps >= 0, "secant_steps", "must not be negative (0 means never)");
  require(least_metric >= 0 && std::isfinite(least_metric), "least_metric", "must be finite and not negative");
  require(first_damping > 0 && std::isfinite(first_damping), "first_damping", "must be above 0 and finite");
  require(cost_tolerance >= 0 && cost_tolerance < 1, "cost_tolerance", "must be at least 0 and below 1");
  require(slow_iterations >= 0, "slow_iterations", "must not be negative (0 means never)");
  require(cost_floor >= 0, "cost_floor", "must not be negative");
  require(step_tolerance > 0 && step_tolerance < step_limit, "step_tolerance",
          "must be above 0 and below 'step_limit'");
  require(!std::isnan(cost_goal), "cost_goal", "must be a number");
  require(loss_scale > 0 && std::isfinite(loss_scale), "loss_scale", "must be above 0 and finite");
}

LeastSquaresResult minimise_least_squares(const LeastSquaresProblem& problem, const Point& start,
                                          const LeastSquaresOptions& options) {
  options.validate();
  return Search(problem, options).run(start);
}

SearchEnd without_rows(const LeastSquaresResult& end) {
  return {end.point,      end.start_cost, end.promised_gain, end.central, end.evaluations, end.failed_evaluations,
          end.iterations, end.reason,     end.stop};
}

LeastSquaresResult with_rows(const SearchEnd& end, const LeastSquaresProblem& problem,
                             const LeastSquaresOptions& options) {
  return Search(problem, options).again(end);
}

void take_stock(LeastSquaresResult& end, NormalEquations equations, const LeastSquaresOptions& options) {
  end.misfit = 0.5 * end.residual.squaredNorm();
  end.cost = robust_cost(end.residual, options.loss, options.loss_scale);
  const LeastSquaresProblem problem{static_cast<int>(end.point.size()), {}, {}};
  Search(problem, options).take_stock(end, std::move(equations));
}

SearchStop stop_of(StopReason reason, const LeastSquaresOptions& options) {
  using How = SearchStop::How;
  switch (reason) {
    case StopReason::converged:
      return {How::converged};
    case StopReason::goal:
      return {How::goal};
    case StopReason::stalled:
      return {How::stalled};
    case StopReason::iteration_limit:
      return {How::iteration_limit, options.max_iterations};
    case StopReason::evaluation_limit:
      return {How::evaluation_limit, options.max_evaluations};
    case StopReason::interrupted:
      return {How::interrupted};
    case StopReason::start_failed:
      return {How::start_failed};
  }
  return {};
}

SearchStop::Figures figures_of(const LeastSquaresResult& end) {
  return {end.cost, end.gradient_cosine, end.promised_gain};
}

}  // namespace servodx
