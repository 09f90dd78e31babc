#include "fit/log_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "base/error.h"
#include "effects/registry.h"
#include "fit/oil_of.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/noise.h"
#include "signals/smoother.h"
#include "signals/usual_step.h"

namespace servodx {
namespace {

// Missing input samples are bridged in a line; the ends hold.
std::vector<double> bridged(const std::vector<double>& t, std::vector<double> x) {
  const std::size_t n = x.size();
  std::size_t last = n;  // last present sample
  for (std::size_t k = 0; k < n; ++k) {
    if (std::isnan(x[k])) continue;
    if (last == n) {
      for (std::size_t j = 0; j < k; ++j) x[j] = x[k];
    } else {
      for (std::size_t j = last + 1; j < k; ++j)
        x[j] = x[last] + (x[k] - x[last]) * (t[j] - t[last]) / (t[k] - t[last]);
    }
    last = k;
  }
  if (last < n)
    for (std::size_t j = last + 1; j < n; ++j) x[j] = x[last];
  return x;
}

// The command that passed in a gap is not known, and the valve remembers it for some milliseconds. As long as the gap
// was, at most this long, what comes after is not compared: never more than half of a log is lost to it.
constexpr double gap_memory = 10e-3;  // [s] several time constants of a first stage

std::vector<char> after_gaps(const std::vector<double>& t) {
  std::vector<char> unknown(t.size(), 0);
  if (t.size() < 3) return unknown;
  const double usual = usual_step(t);
  double until = -1e300;
  for (std::size_t k = 1; k < t.size(); ++k) {
    const double step = t[k] - t[k - 1];
    if (step > gap_over_step * usual) until = std::max(until, t[k] + std::min(step, gap_memory));
    unknown[k] = t[k] < until;
  }
  return unknown;
}

// A simulation takes every step of a gap, and over a long one valve and oil go where no sample says. A test stand may
// be read point by point.
constexpr double longest_gap = 10.0, longest_wait = 600.0;  // [s]

void refuse_long_gaps(const Log& log, Ports ports) {
  const double longest = ports == Ports::actuator ? longest_gap : longest_wait;
  const std::vector<double>& t = log.time;
  std::size_t first = 0, gaps = 0;
  for (std::size_t k = 1; k < t.size(); ++k)
    if (t[k] - t[k - 1] > longest && gaps++ == 0) first = k;
  if (gaps == 0) return;
  const double step = t[first] - t[first - 1];
  if (2 * gaps >= t.size() - 1)
    throw InputError({.file = log.path, .column = "time"}, fmt::format("its rows are {:.6g} s apart", step),
                     "look at the unit of time: is it in ms or us, and read as s?");
  throw InputError({.file = log.path, .column = "time"},
                   fmt::format("a gap of {:.6g} s between rows {} and {}", step, first, first + 1),
                   "cut the log there: each part is a log of its own");
}

double mean_of_present(const std::vector<double>& x) {
  double sum = 0;
  long n = 0;
  for (double v : x)
    if (!std::isnan(v)) sum += v, ++n;
  return n ? sum / static_cast<double>(n) : std::nan("");
}

std::optional<double> first_present(const std::vector<double>& x) {
  for (double v : x)
    if (!std::isnan(v)) return v;
  return std::nullopt;
}

constexpr double start_span = 0.0101;  // [s] over which the speed at the start is measured

// Slope of the first samples, least squares.
double starting_slope(const std::vector<double>& t, const std::vector<double>& x) {
  double st = 0, sx = 0, stt = 0, stx = 0;
  int n = 0;
  for (std::size_t k = 0; k < x.size() && t[k] - t[0] < start_span; ++k) {
    if (std::isnan(x[k])) continue;
    const double s = t[k] - t[0];
    st += s, sx += x[k], stt += s * s, stx += s * x[k], ++n;
  }
  const double spread = n * stt - st * st;
  return n >= 3 && spread > 0 ? (n * stx - st * sx) / spread : 0.0;
}

}  // namespace

void take_start(LogData& log) {
  Scenario& s = log.scenario;
  for (const FitChannel& c : log.channels) {
    if (c.signal == Signal::spool_position) s.spool_start = first_present(c.measured);
    if (c.signal == Signal::pressure_a) s.pressure_a_start = first_present(c.measured);
    if (c.signal == Signal::pressure_b) s.pressure_b_start = first_present(c.measured);
    if (c.signal == Signal::piston_position) {
      s.piston_start = first_present(c.measured);
      s.piston_velocity_start = starting_slope(s.time, c.measured);
    }
  }
}

std::optional<double> measured_oil_temperature(const Log& log) {
  if (!log.has(Signal::oil_temperature)) return std::nullopt;
  return mean_of_present(log[Signal::oil_temperature]);
}

double starting_slope_error(const std::vector<double>& t) {
  double st = 0, stt = 0, n = 0;
  for (std::size_t k = 0; k < t.size() && t[k] - t[0] < start_span; ++k) {
    const double s = t[k] - t[0];
    st += s, stt += s * s, ++n;
  }
  const double spread = n * stt - st * st;
  return n >= 3 && spread > 0 ? std::sqrt(n / spread) : 0.0;
}

Ports ports_of(const Log& log, const RigFile& rig) {
  const bool has_actuator =
      log.has(Signal::piston_position) || (log.has(Signal::pressure_a) && log.has(Signal::pressure_b));
  const bool leakage = log.has(Signal::leakage_flow), flow = log.has(Signal::control_flow);
  if (rig.ports == Ports::actuator && has_actuator) return Ports::actuator;
  if (leakage != flow) return leakage ? Ports::blocked : Ports::free;
  // Free ports hold no load pressure.
  if (rig.ports == Ports::free && log.has(Signal::load_pressure) && !flow) return Ports::blocked;
  return rig.ports;
}

bool all_on_test_stand(const std::vector<Log>& logs, const RigFile& rig) {
  return std::all_of(logs.begin(), logs.end(), [&](const Log& l) { return ports_of(l, rig) != Ports::actuator; });
}

namespace {

// Free ports: the valve is given its drop, as logged or as the data sheet rates its flow, where no supply was logged.
void take_valve_drop(Scenario& s, const Log& log, const RigFile& rig, std::vector<Note>& notes) {
  if (s.ports != Ports::free || !s.supply_pressure.empty()) return;
  const auto rated = rig.fact("valve.rated_pressure_drop");
  if (log.has(Signal::valve_pressure_drop)) {
    s.supply_pressure = bridged(log.time, log[Signal::valve_pressure_drop]);
  } else if (rated) {
    s.supply_pressure.assign(log.time.size(), *rated);
    notes.push_back(
        {Note::Kind::no_supply,
         log.path + ": no supply pressure is logged; the drop over the valve is valve.rated_pressure_drop"});
  } else {
    return;
  }
  const double table = rig.fact("supply.return_pressure").value_or(0.0);
  for (std::size_t k = 0; k < s.supply_pressure.size(); ++k)
    s.supply_pressure[k] += s.return_pressure.empty() ? table : s.return_pressure[k];
  if (s.return_pressure.empty()) s.return_pressure.assign(log.time.size(), table);
}

// What another channel of the log says already, or what was put in.
bool is_redundant(Signal which, const Log& log, Ports ports) {
  const bool pressures = log.has(Signal::pressure_a) && log.has(Signal::pressure_b);
  switch (which) {
    case Signal::load_pressure:
      return pressures || ports == Ports::free;
    case Signal::valve_pressure_drop:
      return pressures || log.has(Signal::load_pressure) || ports == Ports::free;
    case Signal::control_flow:
      return (log.has(Signal::flow_a) && log.has(Signal::flow_b)) || ports == Ports::blocked;
    case Signal::leakage_flow:
      return ports != Ports::blocked;  // by its definition
    default:
      return false;
  }
}

// As the rig file states it of this signal, or of all.
std::optional<LowPass> low_pass_of(Signal which, const std::vector<double>& time, const RigFile& rig) {
  const std::string all = "measurement.low_pass";
  const auto own = rig.fact(all + "." + std::string(info(which).name)), cutoff = own ? own : rig.fact(all);
  if (!cutoff) return std::nullopt;
  constexpr int usual_order = 2;  // Sallen and Key's stage, as signal conditioners have it
  constexpr const char* order_key = "measurement.low_pass_order";
  const auto order = rig.words.find(order_key);
  return LowPass(time, *cutoff, order == rig.words.end() ? usual_order : order->second.front() - '0');
}

}  // namespace

long present_samples(const FitChannel& c) {
  return std::count_if(c.measured.begin(), c.measured.end(), [](double v) { return !std::isnan(v); });
}

LogData prepare(const Log& log, const RigFile& rig, int window) {
  LogData out;
  out.path = log.path;
  out.sha256 = log.sha256;
  out.notes = log.notes;
  Scenario& s = out.scenario;
  s.time = log.time;
  s.current_measured = log.has(Signal::coil_current);
  s.command = bridged(log.time, log[s.current_measured ? Signal::coil_current : Signal::command]);
  const auto input = [&](Signal which) {
    return log.has(which) ? without_noise(bridged(log.time, log[which])) : std::vector<double>{};
  };
  s.supply_pressure = input(Signal::supply_pressure);
  s.return_pressure = input(Signal::return_pressure);
  s.load_force = input(Signal::load_force);
  s.ports = ports_of(log, rig);
  refuse_long_gaps(log, s.ports);
  if (s.ports != rig.ports)
    out.notes.push_back(
        {Note::Kind::test_stand, fmt::format("{}: taken as of a valve on a test stand with {} ports", log.path,
                                             s.ports == Ports::blocked ? "blocked" : "free")});
  take_valve_drop(s, log, rig, out.notes);
  s.rated_current = rig.fact("valve.rated_current").value_or(0.02);
  if (rig.command_hold) s.command_slope = *rig.command_hold == CommandHold::linear ? 1.0 : 0.0;
  const std::optional<double> measured = measured_oil_temperature(log);
  const double temperature = measured.value_or(rig.oil_temperature.value_or(reference_oil_temperature));
  s.oil_known = measured.has_value() || rig.oil_temperature.has_value() ||
                s.ports != Ports::actuator;  // a stand holds 40 degC within 6 K (ISO 10770-1)
  if (!s.oil_known)
    out.notes.push_back(
        {Note::Kind::oil, fmt::format("{}: no oil temperature: taken as 40 degC, give or take 20 K", log.path)});
  s.oil = oil_of(rig.fluid, temperature);
  const std::vector<char> unknown = after_gaps(log.time);
  for (Signal which : simulated_signals) {
    if (!log.has(which)) continue;
    if (is_redundant(which, log, s.ports)) {
      out.notes.push_back(
          {Note::Kind::redundant_signal,
           fmt::format("{}: '{}' is left out: it is an input, or another signal says it", log.path, info(which).name)});
      continue;
    }
    FitChannel c;
    c.signal = which;
    c.simulated = simulated_index(which);
    c.measured = log[which];
    c.noise = noise_of(c.measured, log.channels[index(which)].resolution) / std::sqrt(static_cast<double>(window));
    for (std::size_t k = 0; k < unknown.size(); ++k)
      if (unknown[k]) c.measured[k] = std::nan("");
    c.filter.window = window;
    c.filter.mains = rig.mains_frequency.value_or(0.0);
    if (which == Signal::piston_position) c.filter.drift = piston_high_pass;
    c.low_pass = low_pass_of(which, s.time, rig);
    out.channels.push_back(std::move(c));
  }
  take_start(out);
  return out;
}

void require_channels(const LogData& log) {
  if (log.channels.empty())
    throw InputError({.file = log.path}, "holds no signal that the model reports",
                     "log spool or piston position, both chamber pressures or a flow");
}

LogData slice(const LogData& log, std::size_t from, std::size_t to) {
  LogData out = log;
  const auto cut = [&](std::vector<double>& v) {
    if (v.empty()) return;
    v.resize(to);
    v.erase(v.begin(), v.begin() + static_cast<long>(from));
  };
  Scenario& s = out.scenario;
  for (auto* v : {&s.time, &s.command, &s.supply_pressure, &s.return_pressure, &s.load_force, &s.fast.move}) cut(*v);
  if (s.fast) s.fast.at = {s.fast.at.begin() + static_cast<long>(from), s.fast.at.begin() + static_cast<long>(to)};
  for (FitChannel& c : out.channels) {
    cut(c.measured);
    if (c.low_pass) c.low_pass->cut(from, to);
  }
  take_start(out);
  return out;
}

ParameterVector candidate_of(const Table& table) {
  ParameterVector v(n_candidate, 0.0);
  for (int i = 0; i < n_parameters; ++i) v[i] = table[i].nominal;
  for (const EffectInfo& e : effect_list())
    for (std::size_t j = 0; j < e.parameters.size(); ++j) {
      const int at = table.find(e.parameters[j].name);
      v[e.first + static_cast<int>(j)] = at >= 0 ? table[at].nominal : e.parameters[j].off;
    }
  return v;
}

}  // namespace servodx
