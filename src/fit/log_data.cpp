#include "fit/log_data.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "base/error.h"
#include "fit/log_gaps.h"
#include "fit/log_start.h"
#include "fit/oil_of.h"
#include "fit/ports_of.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/drive_of.h"
#include "signals/noise.h"
#include "signals/without_noise.h"

namespace servodx {
namespace {

double mean_of_present(const std::vector<double>& x) {
  double sum = 0;
  long n = 0;
  for (double v : x)
    if (!std::isnan(v)) sum += v, ++n;
  return n ? sum / static_cast<double>(n) : std::nan("");
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

std::optional<double> measured_oil_temperature(const Log& log) {
  if (!log.has(Signal::oil_temperature)) return std::nullopt;
  return mean_of_present(log[Signal::oil_temperature]);
}

long present_samples(const FitChannel& c) {
  return std::count_if(c.measured.begin(), c.measured.end(), [](double v) { return !std::isnan(v); });
}

LogData prepare(const Log& log, const RigFile& rig, const Recorder& recorder) {
  const int window = recorder.moving_average;
  LogData out;
  out.path = log.path;
  out.sha256 = log.sha256;
  out.notes = log.notes;
  Scenario& s = out.scenario;
  s.time = log.time;
  s.current_measured = log.has(Signal::coil_current);
  s.command = bridged(log.time, log[drive_of(log)]);
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
  out.command_slope = recorder.command_slope;
  const std::optional<double> measured = measured_oil_temperature(log);
  const double temperature = measured.value_or(rig.oil_temperature.value_or(reference_oil_temperature));
  s.oil_known = measured.has_value() || rig.oil_temperature.has_value() ||
                s.ports != Ports::actuator;  // a stand holds 40 degC within 6 K (ISO 10770-1)
  if (!s.oil_known)
    out.notes.push_back(
        {Note::Kind::oil, fmt::format("{}: no oil temperature: taken as 40 degC, give or take 20 K", log.path)});
  s.oil = oil_of(rig.fluid, temperature);
  out.fluid = rig.fluid;
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

}  // namespace servodx
