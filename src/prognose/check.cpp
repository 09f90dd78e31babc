#include "prognose/check.h"

#include <cmath>
#include <string>
#include <utility>

#include "base/celsius.h"
#include "fit/candidate_of.h"
#include "fit/fast_log.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/oil_of.h"
#include "fit/recorder.h"
#include "fit/tuned_state.h"
#include "model/state.h"
#include "parameters/list.h"
#include "prognose/constants.h"
#include "prognose/monitor.h"
#include "prognose/preflight.h"
#include "prognose/preflight_figures.h"
#include "servodx/monitor.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Of the work of a check: the fits of an oil that is not known; then that of what wears; the rest is its correction.
constexpr double until_oil = 0.4, until_track = 0.95;

// The same current at the reference state.
Scenario at_reference(const Scenario& as_was, const RigFile& rig) {
  Scenario s = as_was;
  s.supply_pressure.clear();
  s.return_pressure.clear();
  s.load_force.clear();
  s.oil = oil_of(rig.fluid, reference_oil_temperature);
  s.pressure_a_start.reset(), s.pressure_b_start.reset();
  return s;
}

// The monitor as the valve is in a log, and the pressure law that it goes by.
struct Beside {
  MonitorParameters monitor;
  PressureLaw law;
};
Beside monitor_beside(const Table& tuned, const Supply& at, const std::string& model) {
  return {monitor_parameters(tuned, at), pressure_law(model, tuned, at)};
}

void take_oil(CheckResult& out, LogData& data, const Log& log, const Table& tuned, const RigFile& rig,
              const CheckOptions& options) {
  if (log.has(Signal::oil_temperature)) {
    out.temperature = {mean_of_first(log[Signal::oil_temperature], log.samples()), 0.0, OilSource::given};
  } else if (rig.oil_temperature) {
    out.temperature = {*rig.oil_temperature, 0.0, OilSource::given};
  } else if (options.correct) {
    out.temperature = estimate_temperature(
        data, tuned, rig, options.threads, &out.simulations,
        [&](double part) { options.watch.tell("check", until_oil * part, out.simulations); }, options.watch.stop);
    data.scenario.oil = oil_of(rig.fluid, out.temperature.value);
    data.scenario.oil_known = true;
    out.notes.push_back(
        {Note::Kind::oil, "oil temperature estimated from the response; wear that acts like cold oil would shift it"});
  } else {
    out.temperature = {reference_oil_temperature, std::nan(""), OilSource::assumed};
  }
}

// With the monitor as it is: null and offsets are part of what |e| shows.
void add_mean_error(CheckResult& out, const LogData& data, const Beside& beside) {
  const FitChannel* spool = channel_of(data, Signal::spool_position);
  if (!spool) {
    out.notes.push_back(
        {Note::Kind::no_spool, "no spool sensor: |e| and r cannot be had; E(tau) takes the monitor's spool"});
    return;
  }
  const MonitorRun run = run_monitor(beside.monitor, beside.law, data);
  out.mean_error = mean_error(data.scenario.time, spool->measured, run.spool);
  const Figure& figure = out.mean_error.figure;
  out.checks.push_back({CheckName::of_mean_error(), figure.value, figure.std_error, "m", figure.value, 1.0, ""});
}

// [of rated] current at rest less what the spool at rest calls for.
double offset_at_rest(const Preflight& test, const FitChannel& spool, const MonitorParameters& monitor, double rated) {
  return (test.rest_current + monitor.null_current -
          mean_of_first(spool.measured, test.rest) * monitor.wire_stiffness / monitor.motor_gain) /
         rated;
}

Track tracked(CheckResult& out, const LogData& data, const Table& tuned, const RigFile& rig,
              const CheckOptions& options) {
  Track track;
  track.healthy = candidate_of(tuned);
  if (!options.track) return track;
  const long before = out.simulations;
  const double from = before > 0 ? until_oil : 0;
  const auto told = [&](double part, long simulations) {
    options.watch.tell("check", from + (until_track - from) * part, before + simulations);
  };
  track = track_parameters(data, tuned,
                           {.null_limit = rig.null_limit,
                            .threads = options.threads,
                            .last = options.last,
                            .told = told,
                            .stop = options.watch.stop});
  out.simulations += track.simulations;
  out.failed_simulations += track.failed;
  out.adequacy = track.adequacy;
  if (!track.parameters.empty()) out.null = track.null;
  for (const TrackedParameter& p : track.parameters) out.tracked.push_back(p.value);
  return track;
}

// What the model expects of a healthy valve in this log, and what it would at the reference state.
struct Expected {
  PreflightFigures here, reference;
};

Expected expected_of(CheckResult& out, const LogData& data, const Preflight& test, const ParameterVector& healthy,
                     const MonitorRun& at_rest, const Table& tuned, const RigFile& rig, const CheckOptions& options) {
  SimulateOptions how;
  how.threads = options.threads;
  const Trajectory was = simulate(data.scenario, healthy, how);
  LogData other = data;
  other.scenario = at_reference(data.scenario, rig);
  ParameterVector clean = healthy;
  clean[row::air_fraction] = tuned[row::air_fraction].nominal;
  const Trajectory would = simulate(other.scenario, clean, how);
  out.simulations += 2;
  out.failed_simulations += !was.ok + !would.ok;
  if (!was.ok || !would.ok) {
    out.notes.push_back(
        {Note::Kind::uncorrected, "the model's run failed: the checks are not corrected to the reference state"});
    return {};
  }
  const Supply standard{tuned[row::supply_pressure].nominal, tuned[row::return_pressure].nominal, other.scenario.oil,
                        data.scenario.rated_current};
  const Beside beside = monitor_beside(tuned, standard, options.model);
  const MonitorRun run = run_monitor(beside.monitor, beside.law, other, test.rest_current);
  const std::vector<double>& time = data.scenario.time;
  return {figures_of(time, test, traces_of(was, data), at_rest.spool),
          figures_of(time, test, traces_of(would, data), run.spool)};
}

// The measured figure over how the model says that it differs here from the reference state.
void add_corrected(CheckResult& out, CheckName name, const Figure& figure, std::string unit, const Figure* here,
                   const Figure* reference) {
  const bool known = here && reference && here->value / reference->value > 0;
  const double ratio = known ? here->value / reference->value : 1.0;
  out.checks.push_back(
      {std::move(name), figure.value / ratio, figure.std_error / ratio, std::move(unit), figure.value, ratio, ""});
}

void add_fidelity(CheckResult& out, const Fidelity& seen, const Expected& expected) {
  out.no_response = seen.no_response;
  if (out.no_response) {
    out.notes.push_back({Note::Kind::no_response, "no response: the spool did not follow the preflight step"});
    return;
  }
  if (seen.figure.value < 0)
    out.notes.push_back({Note::Kind::against_command,
                         "fidelity is below 0: the spool moved against the command; is the sign of its signal right?"});
  const auto figure = [](const PreflightFigures& f) { return f.fidelity ? &f.fidelity->figure : nullptr; };
  const Figure* reference = figure(expected.reference);
  add_corrected(out, CheckName::of_fidelity(), seen.figure, "1", figure(expected.here), reference);
  // The monitor has no driver and no sensor to lag: r of the healthy valve stands above 1 by theirs. Taken out, it
  // begins at 1.
  if (!reference || !(reference->value > 0)) return;
  out.checks.back().value /= reference->value, out.checks.back().std_error /= reference->value;
}

void add_correlations(CheckResult& out, const Preflight& test, const PreflightFigures& seen, const Expected& expected) {
  for (std::size_t i = 0; i < test.sines.size(); ++i) {
    if (!seen.correlation[i]) continue;
    const auto figure = [&](const PreflightFigures& f) {
      return i < f.correlation.size() && f.correlation[i] ? &*f.correlation[i] : nullptr;
    };
    add_corrected(out, CheckName::of_correlation(test.sines[i].frequency), *seen.correlation[i], "m2",
                  figure(expected.here), figure(expected.reference));
  }
}

void add_parameters(CheckResult& out, const std::vector<TrackedParameter>& parameters) {
  for (const TrackedParameter& p : parameters)
    out.checks.push_back({CheckName::of_row(p.id - 1), p.value, p.std_error,
                          std::string(parameter_list[static_cast<std::size_t>(p.id - 1)].unit), p.value, 1.0,
                          std::string(p.fault->name), p.tuned, p.failed, p.whole_error, p.told, p.along});
}

CheckResult stopped(const Log& log) {
  CheckResult out;
  out.log = log.path, out.sha256 = log.sha256;
  out.interrupted = true;
  return out;
}

}  // namespace

CheckResult check(const Log& log, const Table& tuned, const RigFile& rig, const CheckOptions& options) {
  options.validate();
  const Recorder recorder{1, recorder_of(tuned).command_slope};  // figures are of the samples, not of their averages
  LogData data = prepare(log, rig, recorder), fitted = is_fast(log) ? prepare_at_points(log, rig, recorder) : data;
  require_channels(data);
  CheckResult out;
  out.log = log.path;
  out.sha256 = log.sha256;
  out.notes = log.notes;
  take_oil(out, fitted, log, tuned, rig, options);
  if (options.watch.stopped()) return stopped(log);
  data.scenario.oil = fitted.scenario.oil, data.scenario.oil_known = fitted.scenario.oil_known;
  for (const Note& note : fitted.notes)
    if (note.kind == Note::Kind::resampled) out.notes.push_back(note);

  const Beside beside = monitor_beside(tuned, supply_of(data, tuned), options.model);
  add_mean_error(out, data, beside);
  const Preflight test = find_preflight(data);
  const FitChannel* spool = channel_of(data, Signal::spool_position);
  if (test.step && spool) out.offset = offset_at_rest(test, *spool, beside.monitor, data.scenario.rated_current);
  const Track track = tracked(out, fitted, tuned, rig, options);
  if (options.watch.stopped()) return stopped(log);

  options.watch.tell("check", until_track, out.simulations);
  if (test.step || !test.sines.empty()) {
    const MonitorRun at_rest = run_monitor(beside.monitor, beside.law, data, test.rest_current);
    const PreflightFigures seen = figures_of(data.scenario.time, test, measured_traces(data), at_rest.spool);
    const Expected expected =
        options.correct ? expected_of(out, data, test, track.healthy, at_rest, tuned, rig, options) : Expected{};
    if (seen.fidelity) add_fidelity(out, *seen.fidelity, expected);
    add_correlations(out, test, seen, expected);
  } else {
    out.notes.push_back({Note::Kind::no_preflight,
                         "no preflight test in this log (a small step from rest, or sines): no r, no E(tau)"});
  }
  add_parameters(out, track.parameters);
  options.watch.tell("check", 1, out.simulations);
  return out;
}

}  // namespace servodx
