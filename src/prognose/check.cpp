#include "prognose/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/tuned_state.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr double reference_kelvin = 313.15;

const FitChannel* channel(const LogData& log, Signal signal) {
  for (const FitChannel& c : log.channels)
    if (c.signal == signal) return &c;
  return nullptr;
}

// The preflight figures of one pair of spool and piston traces, measured or simulated.
struct Traces {
  const std::vector<double>* spool = nullptr;  // null: none
  const std::vector<double>* piston = nullptr;
  double spool_noise = 0, piston_noise = 0;
};
struct PreflightFigures {
  std::optional<Fidelity> fidelity;
  std::vector<std::optional<Figure>> correlation;  // one a sine
};

double mean(const std::vector<double>& x, std::size_t n) {
  double sum = 0;
  long present = 0;
  for (std::size_t k = 0; k < n; ++k)
    if (!std::isnan(x[k])) sum += x[k], ++present;
  return present ? sum / static_cast<double>(present) : 0.0;
}

PreflightFigures figures_of(const std::vector<double>& time, const Preflight& test, const Traces& traces,
                            const std::vector<double>& monitor_spool) {
  PreflightFigures out;
  std::vector<double> spool;
  if (traces.spool) {
    spool = *traces.spool;
    const double rest = mean(spool, test.rest);  // the offset, taken off before the checks
    for (double& x : spool) x -= rest;
    if (test.step) out.fidelity = fidelity(time, spool, monitor_spool, *test.step, traces.spool_noise);
  }
  for (const Preflight::Sine& sine : test.sines)
    out.correlation.push_back(traces.piston
                                  ? correlation(time, traces.spool ? spool : monitor_spool, *traces.piston, sine,
                                                traces.spool ? traces.spool_noise : 0.0, traces.piston_noise)
                                  : std::nullopt);
  return out;
}

Traces traces_of(const Trajectory& t, const LogData& log) {
  Traces traces;
  if (const FitChannel* c = channel(log, Signal::spool_position)) traces.spool = &t.signals[c->simulated];
  if (const FitChannel* c = channel(log, Signal::piston_position)) traces.piston = &t.signals[c->simulated];
  return traces;
}

// The same current at the reference state.
Scenario at_reference(const Scenario& as_was, const RigFile& rig) {
  Scenario s = as_was;
  s.supply_pressure.clear();
  s.return_pressure.clear();
  s.load_force.clear();
  s.oil = oil_at(rig.fluid.density, rig.fluid.kinematic_viscosity, reference_kelvin);
  s.pressure_a_start.reset(), s.pressure_b_start.reset();
  return s;
}

}  // namespace

CheckResult check(const Log& log, const Table& tuned, const RigFile& rig, const CheckOptions& options) {
  LogData data = prepare(log, rig);
  require_channels(data);
  const std::vector<double>& time = data.scenario.time;
  CheckResult out;
  out.log = log.path;
  out.sha256 = log.sha256;
  out.notes = log.notes;

  // 1. Oil.
  if (log.has(Signal::oil_temperature)) {
    out.temperature = {mean(log[Signal::oil_temperature], log.samples()), 0.0, OilSource::given};
  } else if (options.correct) {
    out.temperature = estimate_temperature(data, tuned, rig, options.threads, &out.simulations);
    data.scenario.oil = oil_at(rig.fluid.density, rig.fluid.kinematic_viscosity, out.temperature.value);
    data.scenario.oil_known = true;
    out.notes.push_back("oil temperature estimated from the response; wear that acts like cold oil would shift it");
  } else {
    out.temperature = {reference_kelvin, std::nan(""), OilSource::assumed};
  }

  // 2. The monitor beside the log: as it is for |e|, from rest for the preflight checks.
  const MonitorParameters monitor = monitor_parameters(tuned, supply_of(data, tuned));
  const PressureLaw law = pressure_law(options.model, tuned, supply_of(data, tuned));
  const FitChannel* spool = channel(data, Signal::spool_position);
  const FitChannel* piston = channel(data, Signal::piston_position);
  if (spool) {
    const MonitorRun run = run_monitor(monitor, law, data);
    out.mean_error = mean_error(time, spool->measured, run.spool);
    out.checks.push_back({CheckName::of_mean_error(), out.mean_error.figure.value, out.mean_error.figure.std_error, "m",
                          out.mean_error.figure.value, 1.0, ""});
  } else {
    out.notes.push_back("no spool sensor: |e| and r cannot be had; E(tau) takes the monitor's spool");
  }
  const Preflight test = find_preflight(data);
  const bool has_test = test.step || !test.sines.empty();
  if (test.step && spool)
    out.offset = (test.rest_current + monitor.null_current -
                  mean(spool->measured, test.rest) * monitor.wire_stiffness / monitor.motor_gain) /
                 data.scenario.rated_current;

  // 3. What the parameters are.
  Track track;
  track.healthy = candidate_of(tuned);
  if (options.track) {
    track =
        track_parameters(data, tuned, {.null_limit = rig.null_limit, .threads = options.threads, .last = options.last});
    out.simulations += track.simulations;
    out.failed_simulations += track.failed;
    out.adequacy = track.adequacy;
    if (!track.parameters.empty()) out.null = track.null;
    for (const TrackedParameter& p : track.parameters) out.tracked.push_back(p.value);
  }

  // 4. Preflight checks, measured and, where asked, as the model expects them here and at the reference state.
  if (has_test) {
    const MonitorRun at_rest = run_monitor(monitor, law, data, test.rest_current);
    const Traces measured{spool ? &spool->measured : nullptr, piston ? &piston->measured : nullptr,
                          spool ? spool->noise : 0.0, piston ? piston->noise : 0.0};
    const PreflightFigures seen = figures_of(time, test, measured, at_rest.spool);
    PreflightFigures here, reference;
    if (options.correct) {
      SimulateOptions how;
      how.threads = options.threads;
      const Trajectory was = simulate(data.scenario, track.healthy, how);
      LogData other = data;
      other.scenario = at_reference(data.scenario, rig);
      ParameterVector clean = track.healthy;
      clean[row::air_fraction] = tuned[row::air_fraction].nominal;
      const Trajectory would = simulate(other.scenario, clean, how);
      out.simulations += 2;
      out.failed_simulations += !was.ok + !would.ok;
      if (was.ok && would.ok) {
        here = figures_of(time, test, traces_of(was, data), at_rest.spool);
        const Supply standard{tuned[row::supply_pressure].nominal, tuned[row::return_pressure].nominal,
                              other.scenario.oil, data.scenario.rated_current};
        const MonitorRun run = run_monitor(monitor_parameters(tuned, standard),
                                           pressure_law(options.model, tuned, standard), other, test.rest_current);
        reference = figures_of(time, test, traces_of(would, data), run.spool);
      } else {
        out.notes.push_back("the model's run failed: the checks are not corrected to the reference state");
      }
    }
    const auto add = [&](CheckName name, const Figure& figure, std::string unit, const Figure* expected,
                         const Figure* at_40) {
      double ratio = 1.0;
      if (expected && at_40 && expected->value / at_40->value > 0) ratio = expected->value / at_40->value;
      out.checks.push_back(
          {std::move(name), figure.value / ratio, figure.std_error / ratio, std::move(unit), figure.value, ratio, ""});
    };
    if (seen.fidelity) {
      out.no_response = seen.fidelity->no_response;
      if (out.no_response)
        out.notes.push_back("no response: the spool did not follow the preflight step");
      else {
        if (seen.fidelity->figure.value < 0)
          out.notes.push_back(
              "fidelity is below 0: the spool moved against the command; is the sign of its signal right?");
        add(CheckName::of_fidelity(), seen.fidelity->figure, "1", here.fidelity ? &here.fidelity->figure : nullptr,
            reference.fidelity ? &reference.fidelity->figure : nullptr);
      }
    }
    for (std::size_t i = 0; i < test.sines.size(); ++i) {
      if (!seen.correlation[i]) continue;
      const auto figure = [&](const PreflightFigures& f) {
        return i < f.correlation.size() && f.correlation[i] ? &*f.correlation[i] : nullptr;
      };
      add(CheckName::of_correlation(test.sines[i].frequency), *seen.correlation[i], "m2", figure(here),
          figure(reference));
    }
  } else {
    out.notes.push_back("no preflight test in this log (a small step from rest, or sines): no r, no E(tau)");
  }

  for (const TrackedParameter& p : track.parameters)
    out.checks.push_back({CheckName::of_row(p.id - 1), p.value, p.std_error,
                          std::string(parameter_list[static_cast<std::size_t>(p.id - 1)].unit), p.value, 1.0,
                          std::string(p.fault->name), p.tuned, p.failed});
  return out;
}

}  // namespace servodx
