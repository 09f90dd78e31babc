#include "optimise/multi_start.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <limits>
#include <mutex>

#include "base/error.h"
#include "base/meeting.h"
#include "optimise/problem.h"

namespace servodx {
namespace {

struct Request {
  std::span<const Point> points;
  std::vector<Evaluation> values;
};

// All points of all that ask, as one batch.
void serve(const BatchEvaluate& evaluate, const std::vector<Request*>& requests) {
  std::vector<Point> points;
  for (const Request* r : requests) points.insert(points.end(), r->points.begin(), r->points.end());
  std::vector<Evaluation> values = evaluate(points);
  if (values.size() != points.size()) throw std::logic_error("BatchEvaluate returned another number of points");
  auto at = values.begin();
  for (Request* r : requests) {
    const auto end = at + static_cast<std::ptrdiff_t>(r->points.size());
    r->values.assign(std::make_move_iterator(at), std::make_move_iterator(end));
    at = end;
  }
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::vector<LeastSquaresResult> run_all(const LeastSquaresProblem& problem, const std::vector<Point>& starts,
                                        const LeastSquaresOptions& options) {
  const int count = static_cast<int>(starts.size());
  std::vector<LeastSquaresResult> results(count);
  std::mutex one_at_a_time;  // the caller's Jacobian and progress need not be thread-safe
  const auto work = [&](int run, const Meeting<Request>::Ask& ask) {
    LeastSquaresProblem mine;
    mine.n = problem.n;
    mine.evaluate = [&ask](std::span<const Point> points) {
      Request request{points, {}};
      ask(request);
      return std::move(request.values);
    };
    if (problem.jacobian) {
      mine.jacobian = [&](const Point& point, const Eigen::VectorXd& residual, Eigen::MatrixXd& jacobian) {
        const std::lock_guard lock(one_at_a_time);
        return problem.jacobian(point, residual, jacobian);
      };
    }
    LeastSquaresOptions local = options;
    if (options.progress) {
      local.progress = [&](const LeastSquaresProgress& now) {
        const std::lock_guard lock(one_at_a_time);
        return options.progress(now);
      };
    }
    results[run] = minimise_least_squares(mine, starts[run], local);
  };
  Meeting<Request>::hold(count, count, work,
                         [&](const std::vector<Request*>& requests) { serve(problem.evaluate, requests); });
  return results;
}

}  // namespace

void MultiStartOptions::validate() const {
  local.validate();
  if (!(basin_relative >= 0)) throw InputError({}, "option 'basin_relative' must not be negative", "");
  if (!(basin_absolute >= 0)) throw InputError({}, "option 'basin_absolute' must not be negative", "");
}

MultiStartResult minimise_from_starts(const LeastSquaresProblem& problem, const std::vector<Point>& starts,
                                      const MultiStartOptions& options) {
  options.validate();
  MultiStartResult result;
  std::vector<LeastSquaresResult> runs = run_all(problem, starts, options.local);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const LeastSquaresResult& run = runs[k];
    result.runs.push_back(
        {starts[k], run.point, run.cost, 0, false, run.evaluations, run.iterations, run.reason, run.stopped});
    result.evaluations += run.evaluations;
    result.failed_evaluations += run.failed_evaluations;
    if (run.reason != StopReason::start_failed && (result.best_run < 0 || run.cost < runs[result.best_run].cost))
      result.best_run = static_cast<int>(k);
  }
  if (result.best_run < 0) {
    result.summary = "none of " + std::to_string(starts.size()) + " starts could be evaluated";
    return result;
  }
  result.best = std::move(runs[result.best_run]);
  double next = std::numeric_limits<double>::infinity();
  for (MultiStartRun& run : result.runs) {
    for (int j = 0; j < problem.n; ++j)
      run.distance = std::max(run.distance, std::abs(run.point[j] - result.best.point[j]));
    run.in_best_basin =
        run.reason != StopReason::start_failed &&
        run.cost - result.best.cost <= std::max(options.basin_absolute, options.basin_relative * result.best.cost);
    if (run.in_best_basin) {
      ++result.reached;
    } else {
      next = std::min(next, run.cost);
    }
  }
  result.summary = std::to_string(result.reached) + " of " + std::to_string(starts.size()) +
                   " starts reached the best cost " + number(result.best.cost) + " (within " +
                   number(100 * options.basin_relative) + " %)";
  if (std::isfinite(next)) result.summary += "; next best " + number(next);
  return result;
}

}  // namespace servodx
