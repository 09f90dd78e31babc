#include "fit/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/progress.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/nominal.h"
#include "fit/problem.h"
#include "fit/profile.h"
#include "fit/thin.h"
#include "fit/uncertainty.h"
#include "optimise/derivative_free.h"
#include "optimise/genetic.h"

namespace servodx {
namespace {

constexpr double tuning_null_limit = 0.1;  // fault-free logs: a null may sit anywhere that calibration allows
constexpr double independent_rate = 40;    // [1/s] samples that count before anything is known of their correlation

double rms_of(const std::vector<double>& r, std::size_t from, std::size_t to) {
  double sum = 0;
  long n = 0;
  for (std::size_t k = from; k < to && k < r.size(); ++k)
    if (!std::isnan(r[k])) sum += r[k] * r[k], ++n;
  return n ? std::sqrt(sum / static_cast<double>(n)) : 0.0;
}

// Priors asked for, about the table's nominal.
void take_priors(std::vector<FreeValue>& shared, const std::map<std::string, double>& priors) {
  for (const auto& [name, sd] : priors) {
    const auto f = std::find_if(shared.begin(), shared.end(), [&](const FreeValue& v) { return v.name == name; });
    if (f == shared.end())
      throw InputError({.file = "--prior"}, "'" + name + "' is not among the rows that are fitted",
                       "name a row with estimate 1; row 41 and the air are each log's own");
    const double slope = f->log_scale ? f->start * std::log(f->upper / f->lower) : f->upper - f->lower;
    f->prior_sd = sd / slope;
  }
}

// Everything a run of `tune` carries from step to step.
struct Tuning {
  const TuneOptions& options;
  Progress progress;
  std::vector<LogData> data;
  std::vector<const LogData*> logs;
  Table table;
  ParameterVector base;
  std::vector<FreeValue> shared, nuisances;
  long simulations = 0, failed = 0;
  std::vector<std::string> notes;
  std::vector<ConvergencePoint> convergence = {};
  double creep_step = SimulateOptions{}.creep_step;  // [s]
  bool on_stand = false;

  bool stopped() const { return options.stop && options.stop->load(); }
  SimulateOptions simulate_options() const {
    SimulateOptions s;
    s.threads = options.threads;
    s.creep_step = creep_step;
    return s;
  }
  std::vector<FreeValue> all() const {
    std::vector<FreeValue> free = shared;
    free.insert(free.end(), nuisances.begin(), nuisances.end());
    return free;
  }
};

// Whitening before anything is known: the residual's own size, a few tens of independent samples a second.
void first_whitening(FitProblem& problem, const Point& x) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  for (std::size_t l = 0; l < t.size(); ++l) {
    const LogData& log = *problem.logs()[l];
    const double span = log.scenario.time.back() - log.scenario.time.front();
    const double correlated = static_cast<double>(log.scenario.time.size()) / std::max(1.0, span * independent_rate);
    for (std::size_t c = 0; c < log.channels.size(); ++c) {
      const int li = static_cast<int>(l), ci = static_cast<int>(c);
      const double r = t[l].ok ? rms_of(problem.raw_residual(li, ci, t[l]), 0, log.scenario.time.size())
                               : 100 * log.channels[c].noise;
      problem.set_sigma(li, ci, std::max(2 * log.channels[c].noise, 0.7 * r) * std::sqrt(std::max(1.0, correlated)));
    }
  }
}

// On a stand the model's error is a curve of the command, not of time: a fast sweep tells as much of it as a slow one,
// so each counts alike, by its own rms.
void weigh_sweeps(FitProblem& problem, const Point& x) {
  const std::vector<Trajectory> t = problem.trajectories(x);
  double samples = 0, sweeps = 0;
  for (const LogData* log : problem.logs())
    for (const FitChannel& c : log->channels) samples += static_cast<double>(c.measured.size()), sweeps += 1;
  for (std::size_t l = 0; l < t.size(); ++l) {
    const LogData& log = *problem.logs()[l];
    for (std::size_t c = 0; c < log.channels.size(); ++c) {
      const int li = static_cast<int>(l), ci = static_cast<int>(c);
      const std::size_t n = log.channels[c].measured.size();
      const double r = t[l].ok ? rms_of(problem.raw_residual(li, ci, t[l]), 0, n) : 100 * log.channels[c].noise;
      problem.set_sigma(li, ci,
                        std::max(log.channels[c].noise, r) * std::sqrt(static_cast<double>(n) / (samples / sweeps)));
    }
  }
}

// Leaves the last part of each log out of the misfit.
void hold_out(FitProblem& problem, double part) {
  constexpr double ignored = 1e30;
  for (std::size_t l = 0; l < problem.logs().size(); ++l)
    for (std::size_t c = 0; c < problem.logs()[l]->channels.size(); ++c) {
      std::vector<double> s = problem.sigma(static_cast<int>(l), static_cast<int>(c));
      for (std::size_t k = static_cast<std::size_t>((1.0 - part) * static_cast<double>(s.size())); k < s.size(); ++k)
        s[k] *= ignored;
      problem.set_sigma(static_cast<int>(l), static_cast<int>(c), std::move(s));
    }
}

// Where a local search begins: at the table's values, at a point that the genetic search found, or where one ended.
enum class Start { nominal, found, ended };

LeastSquaresResult local(Tuning& run, FitProblem& problem, const Point& x, const std::string& stage, int iterations,
                         Start start, double from, double to) {
  if (run.options.derivative_free) {
    // As many points as the other way spends on its Jacobians.
    DerivativeFreeOptions d;
    d.max_evaluations = static_cast<long>(iterations) * (problem.n() + 8);
    d.progress = [&](long evaluations, double) {
      run.progress.update(
          from + (to - from) * static_cast<double>(evaluations) / static_cast<double>(d.max_evaluations),
          run.simulations + problem.simulations());
      return !run.stopped();
    };
    const BatchEvaluate evaluate = [&](std::span<const Point> points) { return problem.evaluate(points); };
    const DerivativeFreeResult found = minimise_without_derivatives(problem.n(), evaluate, x, d);
    LeastSquaresResult end;
    end.point = found.point;
    end.cost = end.misfit = found.cost;
    end.stopped = found.stopped;
    return end;
  }
  LeastSquaresOptions o;
  o.max_iterations = iterations;
  o.difference = Difference::forward;
  o.cost_tolerance = 1e-6;
  o.compressed_first_pass = start != Start::ended;
  if (start == Start::found) o.least_metric = o.from_afar;
  o.progress = [&](const LeastSquaresProgress& p) {
    run.convergence.push_back({stage, run.simulations + problem.simulations(), p.cost});
    run.progress.update(from + (to - from) * p.iteration / iterations, run.simulations + problem.simulations());
    return !run.stopped();
  };
  return minimise_least_squares(problem.least_squares(), x, o);
}

// The first seconds of each log, for the global search; of a test stand's slow sweep they show one end, so all of it.
std::vector<LogData> excerpts(const std::vector<LogData>& logs, double seconds) {
  std::vector<LogData> out;
  for (const LogData& log : logs) {
    if (log.scenario.ports != Ports::actuator) {
      out.push_back(log);
      continue;
    }
    const auto& t = log.scenario.time;
    out.push_back(
        slice(log, 0, static_cast<std::size_t>(std::lower_bound(t.begin(), t.end(), t.front() + seconds) - t.begin())));
  }
  return out;
}

// Genetic search over the shared values with the nuisances held; returns the best distinct points, best first.
std::vector<Point> breadth(Tuning& run, const Point& start) {
  constexpr double seconds = 1.5;
  const std::vector<LogData> parts = excerpts(run.data, seconds);
  std::vector<const LogData*> logs;
  for (const LogData& p : parts) logs.push_back(&p);
  FitProblem problem(logs, run.base, run.all(), run.simulate_options());
  first_whitening(problem, start);
  const auto n = run.shared.size();
  const auto full = [&](const Point& s) {
    Point x = start;
    std::copy(s.begin(), s.end(), x.begin());
    return x;
  };
  std::vector<Point> whole;  // kept: a generation asks for no memory
  const auto costs = [&](std::span<const Point> points, bool ranking, std::span<const double> bounds) {
    if (whole.size() < points.size()) whole.resize(points.size(), start);
    for (std::size_t k = 0; k < points.size(); ++k) std::copy(points[k].begin(), points[k].end(), whole[k].begin());
    // Compressed residuals: one channel far off must not hide the rest.
    return problem.costs(std::span(whole).first(points.size()), RobustLoss::compressed, 3.0, ranking, bounds);
  };
  // Failure mode identifiers of a fault-free valve: as the table says; a slow first stage; much friction; worn edges.
  const Point nominal(start.begin(), start.begin() + static_cast<long>(n));
  const auto moved = [&](std::initializer_list<std::pair<int, double>> moves) {
    Point p = nominal;
    for (std::size_t j = 0; j < n; ++j)
      for (const auto& [at, factor] : moves)
        if (run.shared[j].at == at) p[j] = run.shared[j].to_unit(run.shared[j].from_unit(p[j]) * factor);
    return p;
  };
  const std::vector<std::vector<Point>> seeds = {
      {nominal},
      {moved({{row::driver_bandwidth, 0.4}, {row::torque_motor_frequency, 0.7}, {row::fixed_orifice_diameter, 0.8}})},
      {moved({{row::spool_friction, 5.0}, {row::piston_coulomb_friction, 3.0}})},
      {moved({{row::radial_clearance, 2.0}, {row::hydraulic_amplifier_gain, 1.3}})}};
  GeneticOptions o;
  o.population = run.options.population;
  o.generations = run.options.generations;
  o.seed = run.options.seed;
  o.archive = 3;
  const BatchCost cost = [&](std::span<const Point> points) { return costs(points, false, {}); };
  GeneticHooks hooks;
  hooks.screen = [&](std::span<const Point> points, std::span<const double> bounds) {
    return costs(points, true, bounds);
  };
  hooks.generation = [&](const GeneticState& s) {
    if (!run.options.checkpoint.empty()) write_file(run.options.checkpoint, to_json(s));
    // Children are ranked by rough runs; what is shown is counted in full.
    constexpr int shown_every = 10;
    if (!s.best.point.empty() && (s.generation % shown_every == 0 || s.generation == o.generations))
      run.convergence.push_back(
          {"genetic search", run.simulations + problem.simulations(), cost(std::span(&s.best.point, 1)).front()});
    run.progress.update(0.1 + 0.25 * s.generation / o.generations, run.simulations + problem.simulations());
    return !run.stopped();
  };
  std::optional<GeneticState> saved;
  if (run.options.resume && !run.options.checkpoint.empty() && std::filesystem::exists(run.options.checkpoint)) {
    std::ifstream file(run.options.checkpoint);
    std::stringstream text;
    text << file.rdbuf();
    saved = genetic_state_from_json(text.str());
  }
  const GeneticResult found = minimise_genetic(static_cast<int>(n), cost, o, seeds, hooks, saved ? &*saved : nullptr);
  run.simulations += problem.simulations();
  run.failed += problem.failed_simulations();
  std::vector<Point> out;
  for (const Individual& i : found.state.archive) out.push_back(full(i.point));
  if (out.empty()) out.push_back(full(found.state.best.point));
  return out;
}

// Alternates fit and error model until the weights settle. An error model that is learnt at an unfinished fit takes an
// offset not yet found for correlation; the channel would count for so few samples that it is never mended. So on the
// way each counts for at least as many as the first whitening takes, and only the last rounds weigh as learnt.
// A stand's sweeps never do. Their residual is one slow curve of the command: by its memory a whole sweep would count
// for a few samples, least where the meter reads finest; by its size beside the speed of the output the flat ends would
// count, and the peak at null not. There weigh_sweeps() holds to the end, and only the errors of the values are taken
// from what is learnt.
LeastSquaresResult refine(Tuning& run, FitProblem& problem, Point x, ErrorModel& error, double held, int rounds,
                          double from, double to) {
  LeastSquaresResult r;
  for (int round = 0; round < rounds; ++round) {
    if (run.on_stand) {
      weigh_sweeps(problem, x);
    } else {
      error = learn_error_model(problem, x);
      if (held > 0 || round == 0)
        for (ChannelError& c : error.channels) c.independent = std::max(c.independent, independent_rate);
      apply_error_model(problem, error, x, true);
    }
    if (held > 0) hold_out(problem, held);
    const double a = from + (to - from) * round / rounds, b = from + (to - from) * (round + 1) / rounds;
    r = local(run, problem, x, held > 0 ? "weights" : "everything", 12, Start::ended, a, b);
    x = r.point;
    if (run.stopped() || (round >= 1 && r.reason == StopReason::converged)) break;
  }
  return r;
}

}  // namespace

std::vector<std::string> default_effects(bool on_stand) {
  if (on_stand) return {"magnetic_hysteresis", "flow_meter_lag", "edge_radius", "port_line"};
  return {"magnetic_hysteresis", "armature_angle", "mount_compliance", "edge_transition", "orifice_length",
          "screen_drop",         "nozzle_land",    "seal_shear",       "nozzle_mismatch"};
}

void TuneOptions::validate() const {
  const auto require = [](bool holds, const char* option, const std::string& rule, const std::string& mend) {
    if (!holds) throw InputError({.file = option}, rule, mend);
  };
  require(!resume || !checkpoint.empty(), "--resume", "there is nothing to resume from", "add --checkpoint FILE");
  require(!resume || std::filesystem::exists(checkpoint), "--checkpoint",
          "'" + checkpoint + "' is not there to resume from", "leave out --resume to begin");
  require(population >= 24, "--population", "must be at least 24", "four islands of six each");
  require(generations >= 0, "--generations", "must not be negative", "0 leaves the genetic search out");
  require(rounds >= 1, "--rounds", "must be at least 1", fmt::format("{} is the default", TuneOptions{}.rounds));
  require(heldout >= 0 && heldout < 1, "--heldout", "is a part of each log, from 0 to below 1",
          fmt::format("{} is the default", TuneOptions{}.heldout));
  require(moving_average >= 1 && moving_average % 2 == 1, "--moving-average",
          fmt::format("{} is not an odd number of samples", moving_average), "give 1 for none, or 3, 5, ...");
}

TuneResult tune(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig, const TuneOptions& options) {
  options.validate();
  Tuning run{options, Progress("tune", {.quiet = options.quiet}), {}, {}, nominal, {}, {}, {}, 0, 0, {}};
  TuneResult out;

  // 1. What is fitted to what.
  for (const Log& log : logs) {
    run.data.push_back(prepare_thinned(log, rig, options.moving_average));
    const std::vector<std::string>& notes = run.data.back().notes;
    run.notes.insert(run.notes.end(), notes.begin() + static_cast<long>(log.notes.size()), notes.end());
  }
  run.creep_step = creep_step_of(logs, rig);
  run.on_stand = all_on_test_stand(logs, rig);
  for (const LogData& d : run.data) {
    require_channels(d);
    run.logs.push_back(&d);
  }
  RigFile facts = rig;
  if (run.on_stand && facts.ports == Ports::actuator) facts.ports = Ports::blocked;  // the logs say so
  add_effect_rows(run.table, options.effects.value_or(default_effects(run.on_stand)));
  run.table = apply_rig_facts(run.table, facts);
  run.base = candidate_of(run.table);
  // Clearances and frictions know their oil's viscosity as a factor only: without a temperature anywhere they hold for
  // the first log's oil.
  if (std::none_of(run.data.begin(), run.data.end(), [](const LogData& d) { return d.scenario.oil_known; })) {
    run.data.front().scenario.oil_known = true;
    run.notes.push_back("no log holds the oil's temperature: the table holds for the oil of " + run.data.front().path +
                        ", taken as at 40 degC");
  }
  run.shared = shared_values(run.table);
  take_priors(run.shared, options.priors);
  for (std::size_t l = 0; l < run.data.size(); ++l) {
    for (FreeValue& f : nuisance_values(run.data[l], static_cast<int>(l), run.base, tuning_null_limit))
      run.nuisances.push_back(std::move(f));
    for (FreeValue& f : start_values(run.data[l], static_cast<int>(l))) run.nuisances.push_back(std::move(f));
  }
  FitProblem problem(run.logs, run.base, run.all(), run.simulate_options());
  Point x = problem.start();

  // 2. Sensitivities at nominal: each row driven to its bounds, and what the data cannot tell apart is frozen.
  first_whitening(problem, x);
  Evaluation at_nominal = problem.evaluate(std::span(&x, 1)).front();
  if (!at_nominal.ok)
    throw InputError({.file = nominal.path}, "the simulation fails at the table's nominal values",
                     "check the table against the rig's data sheet");
  const std::size_t n_shared = run.shared.size();
  std::vector<Point> extremes;
  for (std::size_t j = 0; j < n_shared; ++j)
    for (double end : {0.0, 1.0}) {
      Point p = x;
      p[j] = end;
      extremes.push_back(p);
    }
  std::vector<std::array<double, 2>> effect(n_shared, {std::nan(""), std::nan("")});
  for (std::size_t first = 0; first < extremes.size(); first += 16) {
    const std::size_t n = std::min<std::size_t>(16, extremes.size() - first);
    const std::vector<Evaluation> e = problem.evaluate(std::span(&extremes[first], n));
    for (std::size_t i = 0; i < n; ++i)
      if (e[i].ok)
        effect[(first + i) / 2][(first + i) % 2] =
            (e[i].residual - at_nominal.residual).head(problem.data_rows()).norm();
    run.progress.update(0.05 * static_cast<double>(first) / static_cast<double>(extremes.size()),
                        problem.simulations());
  }
  Eigen::MatrixXd jacobian;
  std::vector<FreeValue> all_shared = run.shared;
  std::vector<std::string> verdict(n_shared, "bounded");
  std::vector<std::vector<std::string>> confounded(n_shared);
  if (problem.jacobian(x, at_nominal.residual, jacobian)) {
    std::vector<char> candidates(static_cast<std::size_t>(problem.n()), 0);
    std::fill(candidates.begin(), candidates.begin() + static_cast<long>(n_shared), 1);
    // The priors' rows count: a nuisance that its prior holds cannot stand in for a row.
    const Identifiability id = identify(jacobian, candidates);
    std::vector<FreeValue> kept;
    for (std::size_t j = 0; j < n_shared; ++j) {
      // Far from nominal a row may matter that does not here: only what moves nothing anywhere is frozen as flat.
      const bool matters =
          effect[j][0] > 2.0 || effect[j][1] > 2.0 || std::isnan(effect[j][0]) || std::isnan(effect[j][1]);
      if (id.verdict[j] == "flat" && !matters) verdict[j] = "flat";
      if (id.verdict[j] == "confounded") {
        verdict[j] = "confounded";
        for (int k : id.confounded_with[j]) confounded[j].push_back(problem.free()[static_cast<std::size_t>(k)].name);
      }
      if (verdict[j] == "bounded")
        kept.push_back(run.shared[j]);
      else if (const auto off = off_value(run.shared[j].at))  // an effect that the logs do not tell is not claimed
        run.base[run.shared[j].at] =
            run.table.rows[static_cast<std::size_t>(run.table.find(run.shared[j].name))].nominal = *off;
    }
    run.shared = kept;
  }
  run.simulations += problem.simulations();
  run.failed += problem.failed_simulations();

  hold_to_drawings(run.shared, facts, options.priors);

  // 3. Breadth: genetic search, then the local stage from the best distinct points and from nominal.
  FitProblem fit(run.logs, run.base, run.all(), run.simulate_options());
  x = fit.start();
  run.on_stand ? weigh_sweeps(fit, x) : first_whitening(fit, x);
  std::vector<Point> starts = {x};
  if (options.generations > 0 && !run.stopped())
    for (Point& p : breadth(run, x)) starts.push_back(std::move(p));
  hold_out(fit, options.heldout);
  std::vector<LeastSquaresResult> ends;
  for (std::size_t s = 0; s < starts.size() && !(run.stopped() && s > 0); ++s) {
    const double a = 0.35 + 0.35 * static_cast<double>(s) / static_cast<double>(starts.size());
    ends.push_back(local(run, fit, starts[s], fmt::format("start {}", s + 1), 6, s == 0 ? Start::nominal : Start::found,
                         a, a + 0.35 / static_cast<double>(starts.size())));
    out.starts.push_back(ends.back().cost);
  }
  const std::size_t best =
      static_cast<std::size_t>(std::min_element(out.starts.begin(), out.starts.end()) - out.starts.begin());
  for (double c : out.starts) out.reached_best += c <= 1.05 * out.starts[best];
  x = ends[best].point;

  // 4. Weights from the model's own error, alternating with the fit; held-out part still held out.
  LeastSquaresResult end = ends[best];
  if (!run.stopped()) end = refine(run, fit, x, out.error, options.heldout, 1, 0.7, 0.8);
  x = end.point;
  const std::vector<Trajectory> heldout_run = fit.trajectories(x);

  // 5. Final fit on everything.
  if (!run.stopped()) end = refine(run, fit, x, out.error, 0.0, options.rounds, 0.8, 1.0);
  x = end.point;
  out.error = learn_error_model(fit, x);
  apply_error_model(fit, out.error, x);
  const Evaluation final_point = fit.evaluate(std::span(&x, 1)).front();
  if (fit.jacobian(x, final_point.residual, jacobian)) end.jacobian = jacobian;

  // 6. Uncertainty, and the tuned table.
  std::vector<char> kept(static_cast<std::size_t>(fit.n()), 1);
  for (int j = 0; j < fit.n(); ++j)
    kept[static_cast<std::size_t>(j)] =
        x[static_cast<std::size_t>(j)] > 1e-6 && x[static_cast<std::size_t>(j)] < 1 - 1e-6;
  const auto [point, covariance] = uncertainty(fit, x, end.jacobian, kept);
  x = point;
  const std::vector<Trajectory> final_run = fit.trajectories(x);
  out.table = run.table;
  out.table.has_std_error = true;
  const auto derivative = [](const FreeValue& f, double u) {
    return f.log_scale ? f.from_unit(u) * std::log(f.upper / f.lower) : f.upper - f.lower;
  };
  for (std::size_t i = 0; i < run.table.rows.size(); ++i) {
    Row& row = out.table.rows[i];
    const auto free = std::find_if(fit.free().begin(), fit.free().end(),
                                   [&](const FreeValue& f) { return f.log < 0 && f.name == row.name; });
    const auto listed =
        std::find_if(all_shared.begin(), all_shared.end(), [&](const FreeValue& f) { return f.name == row.name; });
    if (listed == all_shared.end()) continue;
    ParameterResult p;
    p.id = row.id;
    p.name = row.name;
    p.unit = row.unit;
    p.nominal = p.estimate = row.nominal;
    p.std_error = std::nan("");
    const auto l = static_cast<std::size_t>(listed - all_shared.begin());
    p.effect_at_lower = effect[l][0];
    p.effect_at_upper = effect[l][1];
    p.confounded_with = confounded[l];
    p.verdict = verdict[l];
    if (free != fit.free().end()) {
      const auto j = static_cast<std::size_t>(free - fit.free().begin());
      p.estimate = free->from_unit(x[j]);
      const double se =
          std::sqrt(std::max(0.0, covariance(static_cast<long>(j), static_cast<long>(j)))) * derivative(*free, x[j]);
      if (!kept[j]) {
        p.verdict = "at_bound";
      } else {
        p.std_error = se;
        const double u_se = std::sqrt(covariance(static_cast<long>(j), static_cast<long>(j)));
        if (u_se > 0.25)
          p.verdict = "flat";
        else if (x[j] - 2 * u_se < 0 || x[j] + 2 * u_se > 1)
          p.verdict = "one_sided";
        row.std_error = se;
      }
      const auto& asked = options.profile;
      const auto asks = [&](const std::string& name) {
        return std::find(asked.begin(), asked.end(), name) != asked.end();
      };
      if (kept[j] && (asks("all") || asks(row.name)) && !run.stopped()) {
        const ProfileInterval interval = profile(fit, x, static_cast<int>(j), covariance);
        p.profile_lower = free->from_unit(interval.lower);
        p.profile_upper = free->from_unit(interval.upper);
        out.notes.push_back(fmt::format(
            "profile of {}: 95 % from {:.4g}{} to {:.4g}{} {}; by curvature {:.4g} to {:.4g}", row.name,
            p.profile_lower, interval.lower_open ? " (its bound)" : "", p.profile_upper,
            interval.upper_open ? " (its bound)" : "", row.unit, p.estimate - 1.96 * se, p.estimate + 1.96 * se));
      }
      row.nominal = p.estimate;
      row.source = "tuned; before: " + run.table.rows[i].source;
    }
    out.parameters.push_back(p);
  }

  // 7. What is left, log by log and pooled.
  std::vector<ChannelResult> pooled;
  std::vector<double> nulls, airs;
  for (std::size_t l = 0; l < run.data.size(); ++l) {
    const ParameterVector v = fit.candidate(x, static_cast<int>(l));
    nulls.push_back(v[row::servovalve_null]);
    airs.push_back(v[row::air_fraction]);
    LogResult lr{
        run.data[l].path, {}, nulls.back(), run.data[l].scenario.command_slope.value_or(v[nuisance::command_slope]), v};
    for (std::size_t c = 0; c < run.data[l].channels.size(); ++c) {
      const FitChannel& channel = run.data[l].channels[c];
      const auto n = channel.measured.size();
      const auto from = static_cast<std::size_t>((1.0 - options.heldout) * static_cast<double>(n));
      ChannelResult r{channel.signal, logs[l].channels[index(channel.signal)].unit, 0, channel.noise, 0};
      if (final_run[l].ok)
        r.rms = rms_of(fit.raw_residual(static_cast<int>(l), static_cast<int>(c), final_run[l]), 0, n);
      if (heldout_run[l].ok)
        r.heldout_rms = rms_of(fit.raw_residual(static_cast<int>(l), static_cast<int>(c), heldout_run[l]), from, n);
      lr.channels.push_back(r);
      auto it =
          std::find_if(pooled.begin(), pooled.end(), [&](const ChannelResult& p) { return p.signal == r.signal; });
      if (it == pooled.end()) it = pooled.insert(pooled.end(), {r.signal, r.unit, 0, 0, 0});
      it->rms += r.rms * r.rms;
      it->noise_rms += r.noise_rms * r.noise_rms;
      it->heldout_rms += r.heldout_rms * r.heldout_rms;
    }
    out.logs.push_back(std::move(lr));
  }
  for (ChannelResult& p : pooled) {
    long n = 0;
    for (const LogResult& l : out.logs)
      for (const ChannelResult& c : l.channels) n += c.signal == p.signal;
    for (double* v : {&p.rms, &p.noise_rms, &p.heldout_rms}) *v = std::sqrt(*v / static_cast<double>(n));
  }
  out.channels = std::move(pooled);
  // Nulls and air belong to the logs; the table keeps their medians.
  const auto median = [](std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
    return v[v.size() / 2];
  };
  out.table[row::servovalve_null].nominal = median(nulls);
  out.table[row::air_fraction].nominal =
      std::clamp(median(airs), out.table[row::air_fraction].lower, out.table[row::air_fraction].upper);
  TunedState state{out.error, options.moving_average, {}};
  for (const Log& log : logs)
    state.by.push_back({std::filesystem::path(log.path).filename().string(), log.sha256, content_hash(log)});
  set_tuned_state(out.table, state);
  out.convergence = run.convergence;
  out.notes.insert(out.notes.begin(), run.notes.begin(), run.notes.end());
  out.notes.push_back("local stage: " + end.stopped);
  std::string slopes;
  for (const LogResult& l : out.logs)
    slopes += fmt::format("{}{} {:.2f}", slopes.empty() ? "" : ", ", std::filesystem::path(l.path).filename().string(),
                          l.command_slope);
  out.notes.push_back("command between samples, 0 held to 1 in a line" +
                      std::string(rig.command_hold ? ", from the rig file: " : ", estimated log by log: ") + slopes);
  std::string viscosities;
  for (const LogResult& l : out.logs)
    if (!run.data[static_cast<std::size_t>(&l - out.logs.data())].scenario.oil_known)
      viscosities +=
          fmt::format("{}{} {:.2f}", viscosities.empty() ? "" : ", ", std::filesystem::path(l.path).filename().string(),
                      l.candidate[effect_row<ViscosityChange>(0)]);
  if (!viscosities.empty())
    out.notes.push_back("viscosity over that at 40 degC, where no temperature was logged: " + viscosities);
  out.simulations = run.simulations + fit.simulations();
  out.failed_simulations = run.failed + fit.failed_simulations();
  out.interrupted = run.stopped();
  return out;
}

}  // namespace servodx
