#include "optimise/derivative_free.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlopt.hpp>

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

std::string in_words(nlopt::result result, long evaluations) {
  const char* why = result == nlopt::FTOL_REACHED      ? "converged in cost"
                    : result == nlopt::XTOL_REACHED    ? "converged in step"
                    : result == nlopt::MAXEVAL_REACHED ? "evaluation limit"
                                                       : "stopped";
  return fmt::format("BOBYQA: {} after {} evaluations", why, evaluations);
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
  double cost = 0;
  try {
    const nlopt::result result = opt.optimize(x, cost);
    search.best.stopped = in_words(result, search.best.evaluations);
  } catch (const nlopt::roundoff_limited&) {
    search.best.stopped = fmt::format("BOBYQA: rounding after {} evaluations", search.best.evaluations);
  } catch (const nlopt::forced_stop&) {
    search.best.stopped = fmt::format("BOBYQA: interrupted after {} evaluations", search.best.evaluations);
  } catch (const std::runtime_error& error) {
    search.best.stopped =
        fmt::format("BOBYQA: gave up after {} evaluations ({})", search.best.evaluations, error.what());
  }
  return std::move(search.best);
}

}  // namespace servodx
