#include "fit/selftest.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/progress.h"
#include "base/random.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/nominal.h"
#include "fit/problem.h"
#include "fit/tune.h"
#include "fit/uncertainty.h"

namespace servodx {
namespace {

constexpr double null_limit = 0.1;      // [fraction of rated] as in a tune
constexpr double nuisance_share = 0.5;  // of the prior's width: true nuisances stay likely under it
constexpr double inside = 0.02;         // truths keep this far from the ends of their interval
constexpr int iterations = 60, usual_iterations = 15;
// Two steps in a row that gain less end a fit: no parameter is a third of a sigma from the minimum then. What the model
// still promises is no measure here: kinks (friction, stops, laps) keep it above zero for ever.
constexpr double settled = 0.05;
constexpr int idle_steps = 2;

// The log as the model would have written it with these parameters.
LogData twin_of(const LogData& log, const Trajectory& truth, const std::vector<double>& noise,
                const std::vector<double>& resolution, Random& random) {
  LogData twin = log;
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    std::vector<double>& y = twin.channels[c].measured;
    const std::vector<double>& x = truth.signals[log.channels[c].simulated];
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double indicated = random.normal(x[k], noise[c]);
      if (std::isnan(y[k])) continue;
      y[k] = resolution[c] > 0 ? resolution[c] * std::round(indicated / resolution[c]) : indicated;
    }
  }
  return slice(twin, 0, twin.scenario.time.size());  // starts from what is now measured first
}

struct Tally {
  double sum = 0, square = 0, errors = 0;
  int n = 0, covered = 0, counted = 0;
};

}  // namespace

SelftestResult selftest(const Log& log, const Table& table, const RigFile& rig, const SelftestOptions& options) {
  const LogData data = prepare(log, rig);
  require_channels(data);
  const Table facts = apply_rig_facts(table, rig);
  const ParameterVector base = candidate_of(facts);
  SimulateOptions simulate_options;
  simulate_options.threads = options.threads;
  SelftestResult out;
  out.log = log.path;

  std::vector<double> noise, resolution;
  for (const FitChannel& c : data.channels) {
    noise.push_back(c.noise);
    resolution.push_back(log.channels[index(c.signal)].resolution);
  }
  const auto whiten = [&](FitProblem& problem) {
    for (std::size_t c = 0; c < noise.size(); ++c)
      problem.set_sigma(0, static_cast<int>(c), std::max(noise[c], 1e-300));
  };

  // Free: what this log can tell. The rest stays at the table's value in truth and fit alike.
  std::vector<FreeValue> free = shared_values(facts);
  std::vector<FreeValue> nuisances = nuisance_values(data, 0, base, null_limit);
  for (FreeValue& f : start_values(data, 0)) nuisances.push_back(std::move(f));
  {
    std::vector<FreeValue> all = free;
    all.insert(all.end(), nuisances.begin(), nuisances.end());
    FitProblem problem({&data}, base, all, simulate_options);
    whiten(problem);
    const Point x = problem.start();
    const Evaluation at = problem.evaluate(std::span(&x, 1)).front();
    Eigen::MatrixXd jacobian;
    if (!at.ok || !problem.jacobian(x, at.residual, jacobian))
      throw InputError({.file = table.path}, "the simulation fails at the table's values on " + log.path,
                       "check the table against the rig's data sheet");
    std::vector<char> candidates(all.size(), 0);
    std::fill(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(free.size()), 1);
    const Identifiability id = identify(jacobian, candidates);
    std::vector<FreeValue> kept;
    for (std::size_t j = 0; j < free.size(); ++j)
      if (id.verdict[j] == "free")
        kept.push_back(free[j]);
      else
        out.held.push_back(free[j].name);
    free = std::move(kept);
    out.simulations = problem.simulations();
    out.failed_simulations = problem.failed_simulations();
  }
  const std::size_t n = free.size();
  if (n == 0)
    throw InputError({.file = log.path}, "this log shows none of the free parameters",
                     "give a log that moves the valve farther");
  free.insert(free.end(), nuisances.begin(), nuisances.end());

  Progress progress("selftest", {.quiet = options.quiet});
  std::vector<Tally> tallies(n);
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    if (options.stop && options.stop->load()) {
      out.interrupted = true;
      break;
    }
    Random random(options.seed, static_cast<std::uint32_t>(repeat));
    const FitProblem maker({&data}, base, free, simulate_options);
    Point truth = maker.start();
    for (std::size_t j = 0; j < truth.size(); ++j) {
      const double width = j < n                             ? options.spread
                           : std::isfinite(free[j].prior_sd) ? nuisance_share * free[j].prior_sd
                                                             : options.spread;
      truth[j] = std::clamp(random.normal(truth[j], width), inside, 1.0 - inside);
    }
    const Trajectory made = maker.trajectories(truth).front();
    out.simulations += maker.simulations();
    if (!made.ok) {
      ++out.repeats, ++out.failed, ++out.failed_simulations;
      continue;
    }
    const LogData twin = twin_of(data, made, noise, resolution, random);
    FitProblem problem({&twin}, base, free, simulate_options);
    whiten(problem);
    LeastSquaresOptions o;
    o.max_iterations = iterations;
    o.difference = Difference::forward;
    o.cost_tolerance = 1e-6;
    // No farther at once than truths scatter: longer first steps drag rows that the log tells poorly into other minima.
    o.step_limit = options.spread;
    double last_cost = HUGE_VAL;  // no robust first pass: a twin has no outliers
    int idle = 0;
    o.progress = [&](const LeastSquaresProgress& now) {
      const double part = std::min(1.0, static_cast<double>(now.iteration) / usual_iterations);
      progress.update((repeat + part) / options.repeats, out.simulations + problem.simulations());
      idle = last_cost - now.cost > settled ? 0 : idle + 1;
      last_cost = now.cost;
      return idle < idle_steps && !(options.stop && options.stop->load());
    };
    const LeastSquaresResult r = minimise_least_squares(problem.least_squares(), problem.start(), o);
    if (options.stop && options.stop->load()) {  // half a fit is none
      out.interrupted = true;
      break;
    }
    out.simulations += problem.simulations();
    out.failed_simulations += problem.failed_simulations();
    ++out.repeats;
    if (r.reason == StopReason::start_failed) {
      ++out.failed;
      continue;
    }
    std::vector<char> kept(free.size());
    for (std::size_t j = 0; j < free.size(); ++j) kept[j] = r.point[j] > 1e-6 && r.point[j] < 1 - 1e-6;
    const auto [point, covariance] = uncertainty(problem, r.point, r.jacobian, kept);
    for (std::size_t j = 0; j < n; ++j) {
      Tally& t = tallies[j];
      const FreeValue& f = free[j];
      const double error = f.from_unit(point[j]) - f.from_unit(truth[j]);
      t.sum += error, t.square += error * error, ++t.n;
      if (!kept[j]) continue;
      const auto k = static_cast<long>(j);
      const double unit_error = std::sqrt(std::max(0.0, covariance(k, k)));
      const double per_unit = f.log_scale ? f.from_unit(point[j]) * std::log(f.upper / f.lower) : f.upper - f.lower;
      t.errors += unit_error * unit_error * per_unit * per_unit;
      t.covered += std::abs(point[j] - truth[j]) <= 1.96 * unit_error;
      ++t.counted;
    }
    progress.update(static_cast<double>(repeat + 1) / options.repeats, out.simulations);
  }

  for (std::size_t j = 0; j < n; ++j) {
    const Tally& t = tallies[j];
    const int at = facts.find(free[j].name);
    SelftestRow row{free[j].name, at >= 0 ? facts[at].unit : "", free[j].start, 0, 0, 0, 0, t.covered, t.counted};
    if (t.n > 0) {
      row.bias = t.sum / t.n;
      row.rms = std::sqrt(t.square / t.n);
      const double spread = std::sqrt(std::max(0.0, t.square / t.n - row.bias * row.bias));
      row.bias_sigmas = t.n > 1 && spread > 0 ? row.bias / (spread / std::sqrt(t.n - 1.0)) : 0;
    }
    if (t.counted > 0) row.std_error = std::sqrt(t.errors / t.counted);
    out.covered += t.covered, out.counted += t.counted;
    out.rows.push_back(std::move(row));
  }
  if (out.counted > 0) {  // Wilson's interval; rows of one repeat are not independent, so it counts repeats
    const double p = static_cast<double>(out.covered) / static_cast<double>(out.counted);
    const double m = std::max(1, out.repeats - out.failed), z = 1.96;
    const double centre = (p + z * z / (2 * m)) / (1 + z * z / m);
    const double half = z / (1 + z * z / m) * std::sqrt(p * (1 - p) / m + z * z / (4 * m * m));
    out.coverage_lower = std::max(0.0, centre - half), out.coverage_upper = std::min(1.0, centre + half);
  }
  return out;
}

}  // namespace servodx
