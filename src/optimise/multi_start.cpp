#include "optimise/multi_start.h"

#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "base/error.h"

namespace servodx {
namespace {

// Runs wait here with the points they want; when every live run waits, the calling thread evaluates them as one batch.
class Meeting {
 public:
  explicit Meeting(int runs) : live_(runs), requests_(runs) {}

  // For a run. Blocks until its values are there.
  std::vector<Evaluation> ask(int run, std::span<const Point> points) {
    std::unique_lock lock(mutex_);
    Request& request = requests_[run];
    request.points = points;
    request.waiting = true;
    ++waiting_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !request.waiting || broken_; });
    if (broken_) throw Broken{};
    return std::move(request.values);
  }

  void leave() {
    const std::lock_guard lock(mutex_);
    --live_;
    changed_.notify_all();
  }

  // For the calling thread: serves until all runs have left.
  void serve(const BatchEvaluate& evaluate) {
    std::unique_lock lock(mutex_);
    for (;;) {
      changed_.wait(lock, [&] { return waiting_ == live_; });
      if (live_ == 0) return;
      std::vector<Point> points;
      for (const Request& request : requests_)
        if (request.waiting) points.insert(points.end(), request.points.begin(), request.points.end());
      std::vector<Evaluation> values = evaluate(points);
      if (values.size() != points.size()) throw std::logic_error("BatchEvaluate returned another number of points");
      std::size_t at = 0;
      for (Request& request : requests_) {
        if (!request.waiting) continue;
        request.values.clear();
        for (std::size_t k = 0; k < request.points.size(); ++k) request.values.push_back(std::move(values[at++]));
        request.waiting = false;
      }
      waiting_ = 0;
      changed_.notify_all();
    }
  }

  void call_off() {
    const std::lock_guard lock(mutex_);
    broken_ = true;
    changed_.notify_all();
  }

  struct Broken {};

 private:
  struct Request {
    std::span<const Point> points;
    std::vector<Evaluation> values;
    bool waiting = false;
  };
  std::mutex mutex_;
  std::condition_variable changed_;
  int live_;
  int waiting_ = 0;
  bool broken_ = false;
  std::vector<Request> requests_;
};

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::vector<LeastSquaresResult> run_all(const LeastSquaresProblem& problem, const std::vector<Point>& starts,
                                        const LeastSquaresOptions& options) {
  const int count = static_cast<int>(starts.size());
  std::vector<LeastSquaresResult> results(count);
  std::vector<std::exception_ptr> errors(count);
  std::mutex one_at_a_time;  // the caller's Jacobian and progress need not be thread-safe
  Meeting meeting(count);
  const auto work = [&](int run) {
    try {
      LeastSquaresProblem mine;
      mine.n = problem.n;
      mine.evaluate = [&meeting, run](std::span<const Point> points) { return meeting.ask(run, points); };
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
    } catch (const Meeting::Broken&) {
    } catch (...) {
      errors[run] = std::current_exception();
    }
    meeting.leave();
  };
  std::exception_ptr served;
  {
    std::vector<std::jthread> threads;
    for (int run = 0; run < count; ++run) threads.emplace_back(work, run);
    try {
      meeting.serve(problem.evaluate);
    } catch (...) {
      served = std::current_exception();
      meeting.call_off();
    }
  }
  if (served) std::rethrow_exception(served);
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
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
