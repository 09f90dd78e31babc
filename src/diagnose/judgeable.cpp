#include "diagnose/judgeable.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/median.h"
#include "base/present.h"
#include "diagnose/constants.h"
#include "diagnose/motion.h"
#include "diagnose/part_below.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

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

const FitChannel* channel_of(const LogData& log, Signal signal) {
  for (const FitChannel& c : log.channels)
    if (c.signal == signal) return &c;
  return nullptr;
}

bool is_noise(const FitChannel& c) { return memory_of(c.measured) < k::no_memory; }

// Something asks it to.
bool spool_moves(const LogData& log, const ParameterVector& base) {
  const FitChannel* spool = channel_of(log, Signal::spool_position);
  return spool && is_large(*spool, base) && !is_noise(*spool);
}

bool is_pressure_of_chamber(Signal s) { return s == Signal::pressure_a || s == Signal::pressure_b; }

bool drives(const std::vector<double>& series, double usual) { return span_of(series) > k::nothing_driven * usual; }

template <class Holds>
bool all_channels(const LogData& log, const Holds& holds) {
  return !log.channels.empty() && std::all_of(log.channels.begin(), log.channels.end(), holds);
}

bool commands_something(const Scenario& in) { return span_of(in.command) > k::nothing_asked * in.rated_current; }

// A command asks something of a valve; a supply or a load that moves does only where a sensor answers it.
bool asked_of(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  if (commands_something(in)) return true;
  const double pressure = base[row::supply_pressure];
  const bool driven =
      drives(in.supply_pressure, pressure) || drives(in.load_force, pressure * base[row::piston_area_a]);
  return driven && !all_channels(log, is_noise);
}

// A jammed valve leaves every sensor its noise beside a command that knows its last sample. One sensor that scatters
// far beyond that, and not with the command, is none of a jam: the pressures of a valve that works move little.
bool is_noise_alone(const LogData& log, const ParameterVector& base) {
  if (!all_channels(log, is_noise)) return false;
  const std::vector<double>& command = log.scenario.command;
  if (memory_of(command) < k::no_memory) return true;  // rows out of order
  return std::any_of(log.channels.begin(), log.channels.end(), [&](const FitChannel& c) {
    return is_large(c, base) && std::abs(correlation(command, c.measured)) < k::no_relation;
  });
}

// A chamber lies between return and supply but for moments. One that is shut in may be above a supply that is off; it
// does not move then.
bool out_of_order(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  const double two_sensors_err = k::order_margin * base[row::supply_pressure];
  const auto most = [&](const std::vector<double>& upper, const std::vector<double>& lower) {
    return part_below(upper, lower, [&](double) { return two_sensors_err; }) > k::out_of_order_part;
  };
  if (most(in.supply_pressure, in.return_pressure)) return true;
  return std::any_of(log.channels.begin(), log.channels.end(), [&](const FitChannel& c) {
    if (!is_pressure_of_chamber(c.signal)) return false;
    return most(c.measured, in.return_pressure) || (is_large(c, base) && most(in.supply_pressure, c.measured));
  });
}

// The flow through the valve's widest opening under twice the supply moves no piston so far in one step. Before and
// after a jump the piston is where several samples say.
bool jumps(const LogData& log, const ParameterVector& base) {
  const FitChannel* piston = channel_of(log, Signal::piston_position);
  if (!piston) return false;
  const std::vector<double>&t = log.scenario.time, &x = piston->measured;
  const double area = std::min(base[row::piston_area_a], base[row::piston_area_b]);
  const double fastest = base[row::port_width] * base[row::spool_stop] *
                         std::sqrt(2 * base[row::supply_pressure] / log.scenario.oil.density) / area;
  const auto about = [&](std::size_t from) {
    return quantile(
        present({x.begin() + static_cast<long>(from), x.begin() + static_cast<long>(from + k::jump_samples)}), 0.5);
  };
  for (std::size_t i = k::jump_samples; i + k::jump_samples <= x.size(); ++i) {
    const double least = k::jump_noise * piston->noise;
    if (!(std::abs(x[i] - x[i - 1]) > least + fastest * (t[i] - t[i - 1]))) continue;
    const double took = t[i + k::jump_samples - 1] - t[i - k::jump_samples];
    if (std::abs(about(i) - about(i - k::jump_samples)) > least + fastest * took) return true;
  }
  return false;
}

bool are_one(const FitChannel& a, const FitChannel& b) {
  std::size_t same = 0;
  for (std::size_t i = 0; i < a.measured.size(); ++i) same += a.measured[i] == b.measured[i];
  return static_cast<double>(same) >= k::still_part * static_cast<double>(a.measured.size());
}

bool holds_a_copy(const LogData& log) {
  for (std::size_t i = 0; i < log.channels.size(); ++i)
    for (std::size_t j = i + 1; j < log.channels.size(); ++j)
      if (!shows_one_value(log.channels[i]) && are_one(log.channels[i], log.channels[j])) return true;
  return false;
}

bool is_coarse(const FitChannel& c) {
  std::vector<double> seen;
  for (const double x : c.measured) {
    if (!std::isfinite(x) || std::find(seen.begin(), seen.end(), x) != seen.end()) continue;
    seen.push_back(x);
    if (seen.size() > k::handful_of_values) return false;
  }
  return true;
}

bool all_moving_are_coarse(const LogData& log, const ParameterVector& base) {
  std::size_t moving = 0;
  for (const FitChannel& c : log.channels) {
    if (!is_large(c, base)) continue;
    if (!is_coarse(c)) return false;
    ++moving;
  }
  return moving > 0;
}

// What no row of a valve's log is.
Unjudgeable unjudgeable_channels(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  const double highest = std::max(base[row::supply_pressure], quantile(present(in.supply_pressure), 0.99));
  for (const FitChannel& c : log.channels) {
    if (is_pressure_of_chamber(c.signal) && quantile(present(c.measured), 0.5) > k::pressure_beyond * highest)
      return Unjudgeable::pressure_beyond_supply;
    if (is_beyond_travel(c, base)) return Unjudgeable::position_beyond_travel;
  }
  if (out_of_order(log, base)) return Unjudgeable::pressures_out_of_order;
  if (all_moving_are_coarse(log, base)) return Unjudgeable::coarse;
  if (holds_a_copy(log)) return Unjudgeable::copied;
  return jumps(log, base) ? Unjudgeable::rows_jump : Unjudgeable::no;
}

}  // namespace

Unjudgeable unjudgeable(const OperatingPoint& point) {
  const auto& oil = point[static_cast<std::size_t>(Condition::oil)];
  return oil && (*oil < coldest_oil || *oil > hottest_oil) ? Unjudgeable::oil_beyond : Unjudgeable::no;
}

bool asks_too_much(const Scenario& in) {
  std::vector<double> size;
  for (const double i : in.command) size.push_back(std::abs(i));
  return quantile(std::move(size), 0.5) > k::command_beyond * in.rated_current;
}

Unjudgeable unjudgeable(const LogData& log, const ParameterVector& base) {
  const Scenario& in = log.scenario;
  const double duration = in.time.back() - in.time.front();
  const double step = duration / static_cast<double>(std::max<std::size_t>(1, in.time.size() - 1));
  if (in.ports == Ports::actuator && (duration < k::shortest_log || step > k::slowest_step))
    return Unjudgeable::too_short;
  if (asks_too_much(in)) return Unjudgeable::command_too_large;
  if (!asked_of(log, base)) return Unjudgeable::nothing_asked;
  if (!commands_something(in) && spool_moves(log, base)) return Unjudgeable::command_missing;
  if (all_channels(log, shows_one_value)) return Unjudgeable::sensors_still;
  if (is_noise_alone(log, base)) return Unjudgeable::noise_alone;
  return unjudgeable_channels(log, base);
}

Unjudgeable unjudgeable(const ReadyLogs& logs, const ParameterVector& base, const std::vector<OperatingPoint>& points) {
  for (const OperatingPoint& point : points)
    if (const Unjudgeable why = unjudgeable(point); why != Unjudgeable::no) return why;
  for (std::size_t l = 0; l < logs.data.size(); ++l)
    if (const Unjudgeable why = unjudgeable(logs.every_sample(l), base); why != Unjudgeable::no) return why;
  return Unjudgeable::no;
}

}  // namespace servodx
