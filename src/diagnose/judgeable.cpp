#include "diagnose/judgeable.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/constants.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

std::vector<double> present(const std::vector<double>& x) {
  std::vector<double> out;
  for (const double v : x)
    if (std::isfinite(v)) out.push_back(v);
  return out;
}

double quantile(std::vector<double> x, double part) {
  if (x.empty()) return 0;
  const auto at = x.begin() + static_cast<long>(part * static_cast<double>(x.size() - 1));
  std::nth_element(x.begin(), at, x.end());
  return *at;
}

// Between the first and the last hundredth: a spike is no motion.
double span_of(const std::vector<double>& x) {
  const std::vector<double> there = present(x);
  return quantile(there, 0.99) - quantile(there, 0.01);
}

bool shows_one_value(const FitChannel& c) {
  const std::vector<double> x = present(c.measured);
  const double usual = quantile(x, 0.5);
  const auto same = std::count(x.begin(), x.end(), usual);
  return static_cast<double>(same) >= k::still_part * static_cast<double>(x.size());
}

// Correlation of neighbouring samples.
double memory_of(const std::vector<double>& measured) {
  const std::vector<double> x = present(measured);
  double mean = 0;
  for (const double v : x) mean += v / static_cast<double>(x.size());
  double with_itself = 0, with_next = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    with_itself += (x[i] - mean) * (x[i] - mean);
    if (i + 1 < x.size()) with_next += (x[i] - mean) * (x[i + 1] - mean);
  }
  return with_itself > 0 ? with_next / with_itself : 0.0;
}

// What moves a channel by itself beyond its usual size.
double usual_span_of(Signal signal, const ParameterVector& base) {
  if (signal == Signal::spool_position) return base[row::spool_stop];
  if (signal == Signal::piston_position) return base[row::piston_stroke];
  return base[row::supply_pressure];
}

bool is_large(const FitChannel& c, const ParameterVector& base) {
  return span_of(c.measured) > k::large_noise * usual_span_of(c.signal, base);
}

bool is_beyond_travel(const FitChannel& c, const ParameterVector& base) {
  if (c.signal == Signal::piston_position) return span_of(c.measured) > k::travel_beyond * base[row::piston_stroke];
  if (c.signal != Signal::spool_position) return false;
  std::vector<double> travel = present(c.measured);
  for (double& x : travel) x = std::abs(x);
  return quantile(std::move(travel), 0.9) > k::travel_beyond * base[row::spool_stop];
}

bool is_noise(const FitChannel& c) { return memory_of(c.measured) < k::no_memory; }

bool is_pressure_of_chamber(Signal s) { return s == Signal::pressure_a || s == Signal::pressure_b; }

bool drives(const std::vector<double>& series, double usual) { return span_of(series) > k::nothing_driven * usual; }

template <class Holds>
bool all_channels(const LogData& log, const Holds& holds) {
  return !log.channels.empty() && std::all_of(log.channels.begin(), log.channels.end(), holds);
}

// A command asks something of a valve; a supply or a load that moves does only where a sensor answers it.
bool asked_of(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  if (span_of(in.command) > k::nothing_asked * in.rated_current) return true;
  const double pressure = base[row::supply_pressure];
  const bool driven =
      drives(in.supply_pressure, pressure) || drives(in.load_force, pressure * base[row::piston_area_a]);
  return driven && !all_channels(log, is_noise);
}

}  // namespace

Unjudgeable unjudgeable(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  const double duration = in.time.back() - in.time.front();
  const double step = duration / static_cast<double>(std::max<std::size_t>(1, in.time.size() - 1));
  if (in.ports == Ports::actuator && (duration < k::shortest_log || step > k::slowest_step))
    return Unjudgeable::too_short;
  std::vector<double> size;
  for (const double i : in.command) size.push_back(std::abs(i));
  if (quantile(std::move(size), 0.5) > k::command_beyond * in.rated_current) return Unjudgeable::command_too_large;
  if (!asked_of(log, base)) return Unjudgeable::nothing_asked;
  if (all_channels(log, shows_one_value)) return Unjudgeable::sensors_still;
  // A jammed valve leaves its sensors' noise beside a command that knows its last sample.
  const bool shuffled = memory_of(in.command) < k::no_memory;
  if (all_channels(log, [&](const FitChannel& c) { return is_noise(c) && (shuffled || is_large(c, base)); }))
    return Unjudgeable::noise_alone;
  const double highest = std::max(base[row::supply_pressure], quantile(present(in.supply_pressure), 0.99));
  for (const FitChannel& c : log.channels) {
    if (is_pressure_of_chamber(c.signal) && quantile(present(c.measured), 0.5) > k::pressure_beyond * highest)
      return Unjudgeable::pressure_beyond_supply;
    if (is_beyond_travel(c, base)) return Unjudgeable::position_beyond_travel;
  }
  return Unjudgeable::no;
}

}  // namespace servodx
