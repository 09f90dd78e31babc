#include "servodx/selftest.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "base/normal.h"
#include "base/random.h"
#include "base/require_setting.h"
#include "base/tiny.h"
#include "base/wilson.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/constants.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "fit/uncertainty.h"
#include "optimise/box_least_squares.h"
#include "optimise/local.h"
#include "optimise/unit_cube.h"
#include "parameters/coordinate.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using namespace fit_constants::twin;

// The log as the model would have written it with these parameters.
LogData twin_of(const LogData& log, const Trajectory& truth, const std::vector<double>& noise,
                const std::vector<double>& resolution, Random& random) {
  LogData twin = log;
  for (std::size_t c = 0; c < log.channels.size(); ++c) {
    std::vector<double>& y = twin.channels[c].measured;
    const std::vector<double> x = log.channels[c].shown(truth.signals[log.channels[c].simulated]);
    for (std::size_t k = 0; k < y.size(); ++k) {
      const double indicated = random.normal(x[k], noise[c]);
      if (std::isnan(y[k])) continue;
      y[k] = resolution[c] > 0 ? resolution[c] * std::round(indicated / resolution[c]) : indicated;
    }
  }
  return slice(twin, 0, twin.scenario.time.size());  // starts from what is now measured first
}

// What every repeat shares. The first `rows` of the free values are the table's, the rest the log's nuisances.
struct Experiment {
  LogData data;
  Table facts;  // the table with what the rig file says
  ParameterVector base;
  std::vector<FreeValue> free;
  std::size_t rows = 0;
  std::vector<double> noise, resolution;  // [SI] of each channel
  SimulateOptions simulate;

  FitProblem problem(const LogData& log) const {
    FitProblem out({&log}, base, free, simulate);
    for (std::size_t c = 0; c < noise.size(); ++c) out.set_sigma(0, static_cast<int>(c), std::max(noise[c], tiny));
    return out;
  }
};

Experiment prepared(const Log& log, const Table& table, const RigFile& rig, const SelftestOptions& options) {
  Experiment e;
  e.data = prepare(log, rig);
  require_channels(e.data);
  e.facts = apply_rig_facts(table, rig);
  e.base = candidate_of(e.facts);
  e.simulate.threads = options.threads;
  for (const FitChannel& c : e.data.channels) {
    e.noise.push_back(c.noise);
    e.resolution.push_back(log.channels[index(c.signal)].resolution);
  }
  e.free = shared_values(e.facts);
  e.rows = e.free.size();
  for (FreeValue& f : nuisance_values(e.data, 0, e.base, null_limit)) e.free.push_back(std::move(f));
  for (FreeValue& f : start_values(e.data, 0)) e.free.push_back(std::move(f));
  return e;
}

// Free stays what this log can tell. The rest keeps the table's value in truth and fit alike.
void hold_what_the_log_does_not_tell(Experiment& e, const Table& table, SelftestResult& out) {
  const FitProblem problem = e.problem(e.data);
  const Point x = problem.start();
  const Evaluation at = problem.evaluate(std::span(&x, 1)).front();
  Eigen::MatrixXd jacobian;
  if (!at.ok || !problem.jacobian(x, at.residual, jacobian))
    throw InputError({.file = table.path}, "the simulation fails at the table's values on " + out.log,
                     "check the table against the rig's data sheet");
  std::vector<char> candidates(e.free.size(), 0);
  std::fill(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(e.rows), 1);
  const Identifiability id = identify(jacobian, candidates);
  std::vector<FreeValue> kept;
  for (std::size_t j = 0; j < e.rows; ++j)
    if (id.verdict[j] == RowVerdict::bounded)
      kept.push_back(e.free[j]);
    else
      out.held.push_back(e.free[j].name);
  const std::size_t n = kept.size();
  kept.insert(kept.end(), e.free.begin() + static_cast<std::ptrdiff_t>(e.rows), e.free.end());
  e.free = std::move(kept);
  e.rows = n;
  out.simulations = problem.simulations();
  out.failed_simulations = problem.failed_simulations();
  if (n == 0)
    throw InputError({.file = out.log}, "this log shows none of the free parameters",
                     "give a log that moves the valve farther");
}

Point drawn_truth(const Experiment& e, Point truth, double spread, Random& random) {
  for (std::size_t j = 0; j < truth.size(); ++j) {
    const double width = j < e.rows                          ? spread
                         : std::isfinite(e.free[j].prior_sd) ? nuisance_share * e.free[j].prior_sd
                                                             : spread;
    truth[j] = std::clamp(random.normal(truth[j], width), inside, 1.0 - inside);
  }
  return truth;
}

// `tell` is called at every iteration with the share of a usual fit that is done.
LeastSquaresResult fitted(const FitProblem& problem, const SelftestOptions& options,
                          const std::function<void(double part)>& tell) {
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = cost_tolerance;
  // No farther at once than truths scatter: longer first steps drag rows that the log tells poorly into other minima.
  o.step_limit = options.spread;
  double last_cost = HUGE_VAL;  // no robust first pass: a twin has no outliers
  int idle = 0;
  o.progress = [&](const LeastSquaresProgress& now) {
    tell(std::min(1.0, static_cast<double>(now.iteration) / usual_iterations));
    idle = last_cost - now.cost > settled ? 0 : idle + 1;
    last_cost = now.cost;
    return idle < idle_steps && !options.watch.stopped();
  };
  LocalOptions local;
  local.after_interruption = true;  // a search that idles has settled
  local.stop = [&] { return options.watch.stopped(); };
  return minimise_locally(problem.least_squares(), problem.start(), o, local).end;
}

// What the repeats say of one row.
struct Tally {
  double sum = 0, square = 0, errors = 0;
  int n = 0, covered = 0, counted = 0;

  void add(const FreeValue& f, double estimate, double truth) {
    const double error = f.from_unit(estimate) - f.from_unit(truth);
    sum += error, square += error * error, ++n;
  }
  // `unit_error`: what the fit says of itself, of the unit interval.
  void add_stated(const FreeValue& f, double estimate, double truth, double unit_error) {
    const double per_unit = f.slope(f.from_unit(estimate));
    errors += unit_error * unit_error * per_unit * per_unit;
    covered += std::abs(estimate - truth) <= normal_95 * unit_error;
    ++counted;
  }
};

void add_repeat(std::vector<Tally>& tallies, const Experiment& e, const FitProblem& problem,
                const LeastSquaresResult& r, const Point& truth) {
  std::vector<char> kept(e.free.size());
  for (std::size_t j = 0; j < e.free.size(); ++j) kept[j] = off_walls(r.point[j]);
  const auto [point, covariance] = uncertainty(problem, r.point, r.jacobian, kept);
  for (std::size_t j = 0; j < e.rows; ++j) {
    tallies[j].add(e.free[j], point[j], truth[j]);
    if (!kept[j]) continue;
    const auto k = static_cast<long>(j);
    tallies[j].add_stated(e.free[j], point[j], truth[j], std::sqrt(std::max(0.0, covariance(k, k))));
  }
}

SelftestRow row_of(const Tally& t, const FreeValue& f, const Table& facts) {
  const int at = facts.find(f.name);
  SelftestRow row{f.name, at >= 0 ? facts[at].unit : "", f.start, 0, 0, 0, 0, t.covered, t.counted};
  if (t.n > 0) {
    row.bias = t.sum / t.n;
    row.rms = std::sqrt(t.square / t.n);
    const double spread = std::sqrt(std::max(0.0, t.square / t.n - row.bias * row.bias));
    row.bias_sigmas = t.n > 1 && spread > 0 ? row.bias / (spread / std::sqrt(t.n - 1.0)) : 0;
  }
  if (t.counted > 0) row.std_error = std::sqrt(t.errors / t.counted);
  return row;
}

// Wilson's interval; rows of one repeat are not independent, so it counts repeats.
void add_coverage(SelftestResult& out) {
  for (const SelftestRow& row : out.rows) out.covered += row.covered, out.counted += row.counted;
  if (out.counted == 0) return;
  const double p = static_cast<double>(out.covered) / static_cast<double>(out.counted);
  const double m = std::max(1, out.repeats - out.failed);
  const RateInterval interval = wilson_95(p * m, m);
  out.coverage_lower = interval.lower, out.coverage_upper = interval.upper;
}

}  // namespace

void SelftestOptions::validate() const {
  require_setting(repeats >= 2, "--repeats", "must be at least 2", "20 tell a coverage to about 10 %");
  require_setting(spread > 0 && spread <= 0.25, "--spread", "must lie between 0 and 0.25", "0.05 of a row's interval");
  require_threads(threads);
}

SelftestResult selftest(const Log& log, const Table& table, const RigFile& rig, const SelftestOptions& options) {
  options.validate();
  SelftestResult out;
  out.log = log.path;
  Experiment e = prepared(log, table, rig, options);
  hold_what_the_log_does_not_tell(e, table, out);

  const Watch& watch = options.watch;
  std::vector<Tally> tallies(e.rows);
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    out.interrupted = watch.stopped();
    if (out.interrupted) break;
    Random random(options.seed, static_cast<std::uint32_t>(repeat));
    const FitProblem maker({&e.data}, e.base, e.free, e.simulate);
    const Point truth = drawn_truth(e, maker.start(), options.spread, random);
    const Trajectory made = maker.trajectories(truth).front();
    out.simulations += maker.simulations();
    if (!made.ok) {
      ++out.repeats, ++out.failed, ++out.failed_simulations;
      continue;
    }
    const LogData twin = twin_of(e.data, made, e.noise, e.resolution, random);
    const FitProblem problem = e.problem(twin);
    const LeastSquaresResult r = fitted(problem, options, [&](double part) {
      watch.tell("selftest", (repeat + part) / options.repeats, out.simulations + problem.simulations());
    });
    out.interrupted = watch.stopped();
    if (out.interrupted) break;  // half a fit is none
    out.simulations += problem.simulations();
    out.failed_simulations += problem.failed_simulations();
    ++out.repeats;
    if (r.reason == StopReason::start_failed) {
      ++out.failed;
      continue;
    }
    add_repeat(tallies, e, problem, r, truth);
    watch.tell("selftest", static_cast<double>(repeat + 1) / options.repeats, out.simulations);
  }
  for (std::size_t j = 0; j < e.rows; ++j) out.rows.push_back(row_of(tallies[j], e.free[j], e.facts));
  add_coverage(out);
  return out;
}

}  // namespace servodx
