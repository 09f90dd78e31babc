#include "optimise/derivative_free.h"

#include <algorithm>
#include <limits>
#include <nlopt.hpp>
#include <stdexcept>
#include <utility>

namespace servodx {
namespace {

constexpr double failed_cost = 1e30;

struct Search {
  const BatchEvaluate& evaluate;
  const DerivativeFreeOptions& options;
  DerivativeFreeResult best;
  nlopt::opt* nlopt = nullptr;

  double cost(const Point& x) {
    const Evaluation e = evaluate(std::span(&x, 1)).front();
    ++best.evaluations;
    best.failed_evaluations += !e.ok;
    const double c = e.ok ? 0.5 * e.residual.squaredNorm() : failed_cost;
    if (c < best.cost) best.cost = c, best.point = x;
    if (options.progress && !options.progress(best.evaluations, best.cost)) nlopt->force_stop();
    return c;
  }
};

SearchStop::How how_of(nlopt::result result) {
  switch (result) {
    case nlopt::FTOL_REACHED:
      return SearchStop::How::bobyqa_cost_converged;
    case nlopt::XTOL_REACHED:
      return SearchStop::How::bobyqa_step_converged;
    case nlopt::MAXEVAL_REACHED:
      return SearchStop::How::bobyqa_evaluation_limit;
    default:
      return SearchStop::How::bobyqa_stopped;
  }
}

SearchStop::How minimise(nlopt::opt& opt, Point x) {
  double cost = 0;
  try {
    return how_of(opt.optimize(x, cost));
  } catch (const nlopt::roundoff_limited&) {
    return SearchStop::How::bobyqa_rounding;
  } catch (const nlopt::forced_stop&) {
    return SearchStop::How::bobyqa_interrupted;
  } catch (const std::runtime_error&) {
    return SearchStop::How::bobyqa_gave_up;
  }
}

}  // namespace

DerivativeFreeResult minimise_without_derivatives(int n, const BatchEvaluate& evaluate, const Point& start,
                                                  const DerivativeFreeOptions& options) {
  nlopt::opt opt(nlopt::LN_BOBYQA, static_cast<unsigned>(n));
  Search search{evaluate, options, {start, std::numeric_limits<double>::infinity(), 0, 0, {}}, &opt};
  opt.set_lower_bounds(0.0);
  opt.set_upper_bounds(1.0);
  opt.set_initial_step(options.first_step);
  opt.set_ftol_rel(options.cost_tolerance);
  opt.set_xtol_abs(options.step_tolerance);
  opt.set_maxeval(static_cast<int>(options.max_evaluations));
  opt.set_min_objective([](const std::vector<double>& x, std::vector<double>&,
                           void* data) { return static_cast<Search*>(data)->cost(x); },
                        &search);
  Point x = start;
  for (double& u : x) u = std::clamp(u, 0.0, 1.0);
  search.best.stop.how = minimise(opt, std::move(x));
  search.best.stop.count = search.best.evaluations;
  return std::move(search.best);
}

}  // namespace servodx
