#include "prognose/track.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "faults/fault.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "parameters/list.h"
#include "prognose/constants.h"
#include "prognose/held_back.h"
#include "prognose/reading_scale.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {

using namespace prognose_constants;

namespace {

constexpr double no_cost = 1e300;  // of what did not run

// Whitened by how wrong the model is where things move, every sample for itself: what is constant in that error is the
// same in every check of one kind, and a trend does not see it.
void whiten(FitProblem& problem, const LogData& log, const ErrorModel& error, const Trajectory& healthy) {
  for (std::size_t c = 0; c < log.channels.size(); ++c)
    problem.set_sigma(0, static_cast<int>(c), channel_sigma(error, log, c, healthy));
}

// Row that a fault moves first, in the order of the table.
int first_row(const Fault& fault) {
  ParameterVector still(n_candidate, 1.0), moved = still;
  fault.apply(moved.data(), fault.log_scale ? 2 * fault.healthy : fault.healthy + 0.5 * (fault.worst - fault.healthy));
  for (int i = 0; i < n_parameters; ++i)
    if (moved[i] != still[i]) return i;
  return -1;
}

// The whole range, from a little beyond health where that is not an end of the scale: the model's form leaves that
// open, but a motor does not grow stronger, and a wider range lets two faults pull against each other.
FreeValue severity_value(const Fault& fault) {
  FreeValue f;
  f.name = fault.name;
  f.apply = fault.apply;
  f.log_scale = fault.log_scale;
  f.start = fault.healthy;
  const double side = fault.worst > fault.healthy ? -1 : 1;
  const double beyond = fault.log_scale   ? fault.healthy * std::exp(side * healthier * fault.spread)
                        : fault.part_lost ? fault.healthy + side * larger_clean
                                          : fault.healthy;
  f.lower = std::min(beyond, fault.worst);
  f.upper = std::max(beyond, fault.worst);
  f.prior_sd = severity_prior_sd;
  f.log = 0;
  return f;
}

// What wears along with a fault, by how far the candidate has come from the base.
FreeValue along_value(const WornAlong& along, const ParameterVector& base) {
  FreeValue f;
  f.name = std::string(along.name);
  f.apply = [apply = along.apply, base](double* candidate, double share) { apply(candidate, base.data(), share); };
  f.lower = 0, f.upper = along.most;
  f.start = along.likely;
  f.prior_sd = along_prior_sd;
  f.log = 0;
  return f;
}

// Value of the fault's row at a point of the unit interval of its severity; monotone.
double row_at(const ParameterVector& base, const Progressive& p, const FreeValue& severity, double u) {
  ParameterVector v = base;
  p.fault->apply(v.data(), severity.from_unit(std::clamp(u, 0.0, 1.0)));
  return v[p.row];
}

// And back.
double unit_of(const ParameterVector& base, const Progressive& p, const FreeValue& severity, double value) {
  double low = 0, high = 1;
  const bool rises = row_at(base, p, severity, 1) > row_at(base, p, severity, 0);
  for (int k = 0; k < unit_halvings; ++k) {
    const double mid = 0.5 * (low + high);
    ((row_at(base, p, severity, mid) < value) == rises ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

// The severities first, in the order of progressive_faults(), then what wears along, then the log's nuisances.
std::vector<FreeValue> free_values(const LogData& log, const ParameterVector& base, double null_limit) {
  std::vector<FreeValue> free;
  for (const Progressive& p : progressive_faults()) free.push_back(severity_value(*p.fault));
  for (const Progressive& p : progressive_faults())
    if (p.fault->along) free.push_back(along_value(*p.fault->along, base));
  for (FreeValue& f : nuisance_values(log, 0, base, null_limit)) free.push_back(std::move(f));
  return free;
}

// Health, each fault half way, those that something wears along with at their end too, and where the last check ended.
std::vector<Point> starts_from(const Point& health, const ParameterVector& base, const std::vector<FreeValue>& free,
                               const std::vector<double>& last) {
  const auto& faults = progressive_faults();
  std::vector<Point> starts = {health};
  for (std::size_t j = 0; j < faults.size(); ++j) {
    Point x = health;
    x[j] = x[j] < 0.5 ? 0.5 * (1 + x[j]) - short_of_half_way : 0.5 * x[j] + short_of_half_way;
    starts.push_back(x);
  }
  std::size_t along = faults.size();
  for (std::size_t j = 0; j < faults.size(); ++j) {
    if (!faults[j].fault->along) continue;
    Point x = health;
    x[j] = free[j].to_unit(*faults[j].fault->failed);
    starts.push_back(x);
    x[along++] = well_worn;
    starts.push_back(x);
  }
  if (last.size() != faults.size()) return starts;
  Point x = health;
  for (std::size_t j = 0; j < faults.size(); ++j)
    if (std::isfinite(last[j])) x[j] = unit_of(base, faults[j], free[j], last[j]);
  starts.push_back(x);
  return starts;
}

// Those of least misfit, the least first.
std::vector<Point> likeliest(FitProblem& problem, const std::vector<Point>& starts) {
  const std::vector<Evaluation> at = problem.evaluate(starts);
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto misfit = [&](std::size_t i) { return at[i].ok ? at[i].residual.squaredNorm() : no_cost; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return misfit(i) < misfit(j); });
  order.resize(std::min(order.size(), starts_followed));
  std::vector<Point> first;
  for (const std::size_t i : order) first.push_back(starts[i]);
  return first;
}

// A few iterations from each start, more from the best end. None where every start failed.
std::optional<LeastSquaresResult> fit_from(FitProblem& problem, const std::vector<Point>& starts,
                                           const TrackOptions& options) {
  constexpr double all = static_cast<double>(starts_followed) * first_iterations + last_iterations;
  const auto stopped = [&] { return options.stop && options.stop(); };
  double done = 0, furthest = 0;  // iterations: those that a fit did not need are done at its end
  LeastSquaresOptions o;
  o.progress = [&](const LeastSquaresProgress& now) {
    furthest = std::max(furthest, done + std::min(now.iteration, o.max_iterations));
    if (options.told) options.told(furthest / all, problem.simulations());
    return !stopped();
  };
  o.difference = Difference::forward;
  o.cost_tolerance = track_cost_tolerance;
  o.max_iterations = first_iterations;
  const LeastSquaresProblem least = problem.least_squares();
  LeastSquaresResult best;
  best.cost = no_cost;
  for (const Point& start : likeliest(problem, starts)) {
    if (stopped()) return {};
    LeastSquaresResult r = minimise_locally(least, start, o).end;
    if (r.reason != StopReason::start_failed && r.cost < best.cost) best = std::move(r);
    done += first_iterations;
  }
  if (!(best.cost < no_cost) || stopped()) return {};
  o.max_iterations = last_iterations;
  LeastSquaresResult r = minimise_locally(least, best.point, o).end;
  if (r.reason != StopReason::start_failed) best = std::move(r);
  if (!(best.cost < no_cost)) return {};
  return best;
}

// Whitened rms of the worst channel.
double adequacy_of(const FitProblem& problem, const LogData& log, const LeastSquaresResult& fit) {
  double worst = 0;
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const auto [first, n] = problem.rows(0, static_cast<int>(c));
    worst = std::max(worst, std::sqrt(fit.residual.segment(first, n).squaredNorm() / static_cast<double>(n)));
  }
  return worst;
}

// The inverse of J'J.
Eigen::MatrixXd covariance_at(const LeastSquaresResult& fit) {
  return covariance_of(fit.jacobian, std::vector<char>(static_cast<std::size_t>(fit.jacobian.cols()), 1));
}

// [of the unit interval] of each number, widened where the fit is worse than on the tuning logs.
std::vector<double> errors_of(const LeastSquaresResult& fit, const Eigen::MatrixXd& covariance, double adequacy) {
  std::vector<double> errors;
  for (long j = 0; j < fit.jacobian.cols(); ++j) {
    const double se = std::sqrt(std::max(0.0, covariance(j, j)));
    errors.push_back(se * std::max(1.0, adequacy));
  }
  return errors;
}

// The same where samples in a row share the model's error: each channel counts for its independent samples alone. And
// no less than what bounds hold back: a number at its bound, repeated, stays there, but that is not what is true of it.
std::vector<double> whole_errors_of(const FitProblem& problem, const LogData& log, const ErrorModel& error,
                                    LeastSquaresResult fit, double adequacy) {
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const auto [first, n] = problem.rows(0, static_cast<int>(c));
    const double root = std::sqrt(effective_of(error.find(log.channels[c].signal), log.scenario.time));
    fit.jacobian.middleRows(first, n) *= root;
    fit.residual.segment(first, n) *= root;
  }
  const Eigen::MatrixXd covariance = covariance_at(fit);
  const Eigen::VectorXd further = held_back(fit.point, fit.residual, fit.jacobian, covariance);
  std::vector<double> errors = errors_of(fit, covariance, adequacy);
  for (std::size_t j = 0; j < errors.size(); ++j) errors[j] = std::max(errors[j], further[static_cast<long>(j)]);
  return errors;
}

// What a log leaves open of a reading beside its error, in the coordinate that tells it: the bores, of a filter's drop;
// the model's form, of a size that adds to none. One that multiplies has the tuned value to stand on.
double left_beside(const Fault& fault) { return fault.part_lost ? left_by_bores : fault.log_scale ? 0 : fault.spread; }

// One wearing parameter in the unit of its row, at `u` of its severity's unit interval.
TrackedParameter parameter_at(const Progressive& p, const ParameterVector& base, const FreeValue& severity, double u,
                              double error, double whole_error) {
  TrackedParameter out;
  out.id = p.row + 1;
  out.fault = p.fault;
  out.severity = severity.from_unit(u);
  out.value = row_at(base, p, severity, u);
  const double h = u < 0.5 ? difference_step : -difference_step;
  const double slope = std::abs((row_at(base, p, severity, u + h) - out.value) / h);
  out.std_error = slope * error;
  out.whole_error = slope * std::max(error, whole_error);
  ParameterVector failed = base;
  p.fault->apply(failed.data(), *p.fault->failed);
  out.tuned = base[p.row];
  out.failed = failed[p.row];
  // A part lost is told by the drop over what is left; near the end of the scale its own error is small, whatever it
  // is.
  ReadingScale scale;
  if (p.fault->part_lost) scale.kind = ReadingScale::Kind::drop;
  const double from_tuned = std::abs(scale.in(out.value) - scale.in(out.tuned)), beside = left_beside(*p.fault);
  out.told = from_tuned > told_beyond * std::hypot(out.whole_error / scale.stretch(out.value), beside);
  return out;
}

// The fit as values of rows, and what a healthy valve would have done in this log.
void take_fit(Track& out, const FitProblem& problem, const LogData& log, const ErrorModel& error,
              const ParameterVector& base, const std::vector<FreeValue>& free, const Point& health,
              const LeastSquaresResult& fit) {
  const auto& faults = progressive_faults();
  out.adequacy = adequacy_of(problem, log, fit);
  const std::vector<double> errors = errors_of(fit, covariance_at(fit), out.adequacy),
                            whole = whole_errors_of(problem, log, error, fit, out.adequacy);
  Point nuisances = fit.point;
  for (std::size_t j = 0; j < faults.size(); ++j) nuisances[j] = health[j];
  out.healthy = problem.candidate(nuisances, 0);
  for (std::size_t j = 0; j < free.size(); ++j)
    if (!free[j].apply && free[j].at == row::servovalve_null) {
      out.null = free[j].from_unit(fit.point[j]);
      out.null_std_error = errors[j] * (free[j].upper - free[j].lower);
    }
  std::size_t along = faults.size();
  for (std::size_t j = 0; j < faults.size(); ++j) {
    out.parameters.push_back(parameter_at(faults[j], base, free[j], fit.point[j], errors[j], whole[j]));
    if (!faults[j].fault->along) continue;
    const double range = free[along].range();
    out.parameters.back().along = {free[along].from_unit(fit.point[along]), range * errors[along],
                                   range * std::max(errors[along], whole[along])};
    ++along;
  }
}

}  // namespace

const std::vector<Progressive>& progressive_faults() {
  static const std::vector<Progressive> list = [] {
    std::vector<Progressive> found;
    for (const Fault* fault : fault_list())
      if (fault->failed) found.push_back({fault, first_row(*fault)});
    return found;
  }();
  return list;
}

Track track_parameters(const LogData& log, const Table& tuned, const TrackOptions& options) {
  const ParameterVector base = candidate_of(tuned);
  const std::vector<FreeValue> free = free_values(log, base, options.null_limit);
  SimulateOptions simulate_options;
  simulate_options.threads = options.threads;
  FitProblem problem({&log}, base, free, simulate_options);
  problem.difference_step = difference_step;
  const Point health = problem.start();
  whiten(problem, log, error_model_of(tuned), problem.trajectories(health).front());
  const auto fit = fit_from(problem, starts_from(health, base, free, options.last), options);

  Track out;
  out.simulations = problem.simulations();
  out.failed = problem.failed_simulations();
  out.healthy = base;
  if (fit)
    take_fit(out, problem, log, error_model_of(tuned), base, free, health, *fit);
  else
    out.adequacy = out.null = out.null_std_error = std::nan("");
  return out;
}

}  // namespace servodx
