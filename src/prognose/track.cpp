#include "prognose/track.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fit/error_model.h"
#include "fit/tuned_state.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"

namespace servodx {
namespace {

constexpr double prior_sd = 0.5;   // [of a severity's range] about health: weak, it only holds what a log cannot tell
constexpr std::size_t tried = 3;   // starts that are followed, those of least misfit
constexpr int few = 4, many = 16;  // iterations of each, and of the best
constexpr double healthier = 3;    // [spreads] by which a row may come out better than tuned
// What is lost of may be larger than the model has it, to half of the drop over a clean filter.
constexpr double larger_clean = 0.41421356237309515;

// Whitened by how wrong the model is where things move, every sample for itself: what is constant in that error is the
// same in every check of one kind, and a trend does not see it.
void whiten(FitProblem& problem, const LogData& log, const ErrorModel& error, const Trajectory& healthy) {
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const FitChannel& channel = log.channels[c];
    std::vector<double> act =
        activity(log.scenario.time, healthy.ok ? healthy.signals[channel.simulated] : channel.measured);
    for (double& a : act)
      if (std::isnan(a)) a = 0;
    problem.set_sigma(0, static_cast<int>(c), sigma_of(error.find(channel.signal), channel.noise, act));
  }
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
  f.prior_sd = prior_sd;
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
  for (int k = 0; k < 50; ++k) {
    const double mid = 0.5 * (low + high);
    ((row_at(base, p, severity, mid) < value) == rises ? low : high) = mid;
  }
  return 0.5 * (low + high);
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
  const ErrorModel error = error_model_of(tuned);
  const auto& faults = progressive_faults();
  std::vector<FreeValue> free;
  for (const Progressive& p : faults) free.push_back(severity_value(*p.fault));
  for (FreeValue& f : nuisance_values(log, 0, base, options.null_limit)) free.push_back(std::move(f));
  SimulateOptions simulate_options;
  simulate_options.threads = options.threads;
  FitProblem problem({&log}, base, free, simulate_options);
  problem.difference_step = 1e-3;
  const Point health = problem.start();
  whiten(problem, log, error, problem.trajectories(health).front());

  // Health, each fault half way, and where the last check ended.
  std::vector<Point> starts = {health};
  for (std::size_t j = 0; j < faults.size(); ++j) {
    Point x = health;
    x[j] = x[j] < 0.5 ? 0.5 * (1 + x[j]) - 0.2 : 0.5 * x[j] + 0.2;
    starts.push_back(x);
  }
  if (options.last.size() == faults.size()) {
    Point x = health;
    for (std::size_t j = 0; j < faults.size(); ++j)
      if (std::isfinite(options.last[j])) x[j] = unit_of(base, faults[j], free[j], options.last[j]);
    starts.push_back(x);
  }
  LeastSquaresOptions o;
  o.difference = Difference::forward;
  o.cost_tolerance = 1e-4;
  o.max_iterations = few;
  const LeastSquaresProblem least = problem.least_squares();
  LeastSquaresResult best;
  best.cost = 1e300;
  const std::vector<Evaluation> at = problem.evaluate(starts);
  std::vector<std::size_t> order(starts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto misfit = [&](std::size_t i) { return at[i].ok ? at[i].residual.squaredNorm() : 1e300; };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return misfit(i) < misfit(j); });
  order.resize(std::min(order.size(), tried));
  for (const std::size_t i : order) {
    const Point& start = starts[i];
    LeastSquaresResult r = minimise_least_squares(least, start, o);
    if (r.reason != StopReason::start_failed && r.cost < best.cost) best = std::move(r);
  }
  Track out;
  if (best.cost < 1e300) {
    o.max_iterations = many;
    LeastSquaresResult r = minimise_least_squares(least, best.point, o);
    if (r.reason != StopReason::start_failed) best = std::move(r);
  }
  out.simulations = problem.simulations();
  out.failed = problem.failed_simulations();
  out.healthy = base;
  if (!(best.cost < 1e300)) {
    out.adequacy = out.null = out.null_std_error = std::nan("");
    return out;
  }

  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    const auto [first, n] = problem.rows(0, static_cast<int>(c));
    out.adequacy =
        std::max(out.adequacy, std::sqrt(best.residual.segment(first, n).squaredNorm() / static_cast<double>(n)));
  }
  const Eigen::MatrixXd covariance = covariance_of(best.jacobian, std::vector<char>(free.size(), 1));
  const auto error_of = [&](std::size_t j) {
    const double se = std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j))));
    return se * std::max(1.0, out.adequacy);  // of the unit interval
  };
  Point nuisances = best.point;
  for (std::size_t j = 0; j < faults.size(); ++j) nuisances[j] = health[j];
  out.healthy = problem.candidate(nuisances, 0);
  for (std::size_t j = 0; j < free.size(); ++j)
    if (!free[j].apply && free[j].at == row::servovalve_null) {
      out.null = free[j].from_unit(best.point[j]);
      out.null_std_error = error_of(j) * (free[j].upper - free[j].lower);
    }
  for (std::size_t j = 0; j < faults.size(); ++j) {
    TrackedParameter p;
    p.id = faults[j].row + 1;
    p.fault = faults[j].fault;
    p.severity = free[j].from_unit(best.point[j]);
    p.value = row_at(base, faults[j], free[j], best.point[j]);
    const double h = best.point[j] < 0.5 ? 1e-3 : -1e-3;
    p.std_error = std::abs((row_at(base, faults[j], free[j], best.point[j] + h) - p.value) / h) * error_of(j);
    ParameterVector failed = base;
    p.fault->apply(failed.data(), *p.fault->failed);
    p.tuned = base[faults[j].row];
    p.failed = failed[faults[j].row];
    out.parameters.push_back(p);
  }
  return out;
}

}  // namespace servodx
