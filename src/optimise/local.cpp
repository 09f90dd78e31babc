#include "optimise/local.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/stopwatch.h"
#include "optimise/derivative_free.h"
#include "optimise/normal_equations.h"
#include "optimise/robust_loss.h"

namespace servodx {
namespace {

// Of the cost, in tolerances: a promise that no step keeps is rounding of the differences up to some ten tolerances.
constexpr double broken_from = 100;
constexpr double rescue_step =
    0.01;  // of the box: the search has arrived nearby, unless its derivatives were all wrong

bool has_residual(const LeastSquaresResult& end) { return end.reason != StopReason::start_failed; }

bool promises(const LeastSquaresResult& end, const LeastSquaresOptions& options, double times) {
  return end.promised_gain > times * options.cost_tolerance * end.cost + options.cost_floor;
}

// Of the Jacobians that may be taken what our search has left.
CeresBudget what_is_left(CeresBudget budget, const LeastSquaresResult& end, const LeastSquaresOptions& options) {
  budget.max_jacobians = std::clamp(options.max_iterations - end.iterations, 0, budget.max_jacobians);
  return budget;
}

bool may_refine(const LeastSquaresResult& end, const LocalOptions& local) {
  if (local.method != LocalMethod::search_then_ceres) return false;
  switch (end.reason) {
    case StopReason::start_failed:
    case StopReason::goal:
      return false;
    case StopReason::interrupted:
      return local.after_interruption && !(local.stop && local.stop());
    case StopReason::converged:
    case StopReason::stalled:
    case StopReason::iteration_limit:
    case StopReason::evaluation_limit:
      return true;
  }
  return false;
}

// What Ceres has moved has another end than our search said. Convergence takes both: a criterion of Ceres, and no
// promise left.
void say_end(LeastSquaresResult& end, const CeresSummary& ceres, const LeastSquaresOptions& options) {
  if (ceres.steps == 0) return;
  if (ceres.end == CeresEnd::converged && !promises(end, options, 1))
    end.reason = StopReason::converged;
  else if (end.reason == StopReason::stalled || end.reason == StopReason::converged)
    end.reason = StopReason::iteration_limit;
  end.stop = stop_of(end.reason, options);
  end.stop.at = figures_of(end);
}

Distrust distrust_of(const LeastSquaresResult& end, const LeastSquaresOptions& options, const LocalOptions& local) {
  if (!has_residual(end)) return Distrust::none;
  if (end.missing_columns > 0) return Distrust::missing_columns;
  const bool stuck = end.reason == StopReason::stalled && promises(end, options, broken_from) &&
                     end.promised_gain > local.trusted_if_less * end.cost;
  return stuck ? Distrust::broken_promise : Distrust::none;
}

// BOBYQA from the end; its point is taken where it is lower, and the end measured there.
void rescue(const LeastSquaresProblem& problem, LeastSquaresResult& end, const LeastSquaresOptions& options,
            const LocalOptions& local) {
  DerivativeFreeOptions free;
  free.max_evaluations = local.rescue_evaluations;
  free.first_step = rescue_step;
  free.progress = [&](long, double) { return !(local.stop && local.stop()); };
  const DerivativeFreeResult found = minimise_without_derivatives(problem.n, problem.evaluate, end.point, free);
  end.evaluations += found.evaluations;
  end.failed_evaluations += found.failed_evaluations;
  if (!(found.cost < end.cost)) return;
  Evaluation at = std::move(problem.evaluate(std::span(&found.point, 1)).front());
  if (!at.ok) return;
  end.point = found.point;
  end.residual = std::move(at.residual);
  // With the Jacobian of the point before: another one would be no truer.
  take_stock(end, normal_equations(end.jacobian, end.residual, options.loss, options.loss_scale), options);
  end.reason = StopReason::stalled;
  end.stop = found.stop;
  end.stop.at = figures_of(end);
}

}  // namespace

LocalResult minimise_locally(const LeastSquaresProblem& problem, const Point& start, const LeastSquaresOptions& options,
                             const LocalOptions& local) {
  LocalResult out;
  LeastSquaresResult& end = out.end;
  const auto spent = [&] { return local.simulations ? local.simulations() : end.evaluations; };
  long simulations = spent();
  int jacobians = 0;
  double before = 0;
  Stopwatch watch;
  const auto tell = [&](StageGain& stage) {
    stage = {before, end.cost, spent() - simulations, end.iterations - jacobians, watch.lap()};
    before = end.cost, simulations = spent(), jacobians = end.iterations;
  };
  if (local.method == LocalMethod::ceres_alone) {
    end = minimise_by_ceres(problem, start, options, &out.ceres);
    before = end.start_cost;
    tell(out.refinement);
    return out;
  }
  const auto search = [&] { return minimise_least_squares(problem, start, options); };
  end = local.through ? local.through(search) : search();
  before = end.start_cost;
  tell(out.search);
  if (may_refine(end, local)) {
    LeastSquaresOptions quiet = options;  // some steps: none of them is worth a word to the user
    quiet.progress = nullptr;
    out.ceres = refine_by_ceres(problem, end, quiet, what_is_left(local.ceres, end, options));
    say_end(end, out.ceres, options);
  }
  tell(out.refinement);
  if (local.rescue_evaluations > 0 && options.loss == RobustLoss::none && !(local.stop && local.stop()))
    out.distrust = distrust_of(end, options, local);
  if (out.distrust != Distrust::none) rescue(problem, end, options, local);
  tell(out.rescue);
  return out;
}

}  // namespace servodx
