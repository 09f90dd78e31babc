#include "diagnose/reading.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "diagnose/constants.h"
#include "diagnose/motion.h"
#include "diagnose/whitening.h"
#include "fit/candidate_of.h"
#include "fit/fast_log.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"
#include "signals/drive_of.h"
#include "simulate/side_by_side.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

constexpr std::array sensors = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                Signal::pressure_b};
constexpr std::array pressures = {Signal::pressure_a, Signal::pressure_b, Signal::supply_pressure,
                                  Signal::return_pressure};
constexpr std::array chambers = {Signal::pressure_a, Signal::pressure_b};
constexpr std::array positions = {Signal::spool_position, Signal::piston_position};

template <std::size_t n>
std::vector<Signal> held(const Log& log, const std::array<Signal, n>& of) {
  std::vector<Signal> out;
  for (const Signal s : of)
    if (log.has(s)) out.push_back(s);
  return out;
}

// One of them, or all: a recorder's unit is a column's or everyone's.
std::vector<std::vector<Signal>> each_and_all(const std::vector<Signal>& of) {
  std::vector<std::vector<Signal>> out;
  out.reserve(of.size() + 1);
  for (const Signal s : of) out.push_back({s});
  if (of.size() > 1) out.push_back(of);
  return out;
}

void add_scales(std::vector<Reading>& out, Misreading kind, const std::vector<std::vector<Signal>>& groups,
                std::span<const double> factors) {
  for (const auto& of : groups)
    for (const double factor : factors)
      if (!of.empty()) out.push_back({kind, factor, of});
}

// A column stands in another's place: every order of the sensors, and an exchange with the pressures around the valve.
void add_exchanges(const Log& log, std::vector<Reading>& out) {
  std::vector<Signal> order = held(log, sensors);
  std::sort(order.begin(), order.end());
  const std::vector<Signal> sorted = order;
  while (std::next_permutation(order.begin(), order.end())) {
    Reading r{Misreading::exchanged, 1, {}, {}};
    for (std::size_t i = 0; i < order.size(); ++i)
      if (order[i] != sorted[i]) r.of.push_back(sorted[i]), r.from.push_back(order[i]);
    out.push_back(r);
  }
  const std::vector<Signal> all = held(log, pressures);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j)
      if (all[j] == Signal::supply_pressure || all[j] == Signal::return_pressure)
        out.push_back({Misreading::exchanged, 1, {all[i], all[j]}, {all[j], all[i]}});
}

std::vector<Reading> of_time(const Log&) {
  std::vector<Reading> out;
  out.reserve(k::time_factors.size());
  for (const double factor : k::time_factors) out.push_back({Misreading::time_scale, factor});
  return out;
}

std::vector<Reading> of_drive(const Log& log) {
  std::vector<Reading> out;
  add_scales(out, Misreading::unit, {{drive_of(log)}}, k::drive_factors);
  return out;
}

std::vector<Reading> of_lengths(const Log& log) {
  std::vector<Reading> out;
  add_scales(out, Misreading::unit, each_and_all(held(log, positions)), k::length_factors);
  return out;
}

std::vector<Reading> of_pressures(const Log& log) {
  std::vector<Reading> out;
  const std::vector<Signal> own = held(log, chambers), all = held(log, pressures);
  add_scales(out, Misreading::unit, {own}, k::pressure_factors);
  if (all != own) add_scales(out, Misreading::unit, {all}, k::pressure_factors);
  return out;
}

std::vector<Reading> of_signs(const Log& log) {
  std::vector<Reading> out;
  std::vector<std::vector<Signal>> groups = each_and_all(held(log, positions));
  groups.push_back({drive_of(log)});
  groups.push_back(held(log, chambers));
  if (log.has(Signal::load_force)) groups.push_back({Signal::load_force});
  add_scales(out, Misreading::turned, groups, std::array{-1.0});
  return out;
}

void append(std::vector<Reading>& to, const std::vector<Reading>& more) {
  to.insert(to.end(), more.begin(), more.end());
}

// What could have made the log one that cannot be judged; of another every mistake.
std::vector<Reading> readings_of(const Log& log, Unjudgeable unjudgeable) {
  std::vector<Reading> out;
  switch (unjudgeable) {
    case Unjudgeable::too_short:
      return of_time(log);
    case Unjudgeable::nothing_asked:
    case Unjudgeable::command_missing:
    case Unjudgeable::command_too_large:
      return of_drive(log);
    case Unjudgeable::pressure_beyond_supply:
    case Unjudgeable::pressures_out_of_order:
      out = of_pressures(log);
      append(out, of_signs(log));
      add_exchanges(log, out);
      return out;
    case Unjudgeable::position_beyond_travel:
      out = of_lengths(log);
      add_exchanges(log, out);
      return out;
    case Unjudgeable::no:
      break;
    default:
      return {};
  }
  append(out, of_time(log));
  append(out, of_drive(log));
  append(out, of_lengths(log));
  append(out, of_pressures(log));
  append(out, of_signs(log));
  add_exchanges(log, out);
  out.push_back({Misreading::reversed});
  return out;
}

template <class Of>
void for_each_value(Log& log, const Of& of) {
  for (std::size_t s = 0; s < log.channels.size(); ++s)
    if (!log.channels[s].value.empty()) of(static_cast<Signal>(s), log.channels[s].value);
}

void delay(Log& log, double late) {
  const double step = (log.time.back() - log.time.front()) / static_cast<double>(log.samples() - 1);
  const auto by = static_cast<long>(std::lround(std::abs(late) / step));
  const auto rows = static_cast<long>(log.samples());
  if (by >= rows) return;
  log.time.resize(static_cast<std::size_t>(rows - by));
  for_each_value(log, [&](Signal s, std::vector<double>& x) {
    const bool is_sensor = std::find(sensors.begin(), sensors.end(), s) != sensors.end();
    const bool from_front = is_sensor == (late > 0);
    if (from_front)
      x.erase(x.begin(), x.begin() + by);
    else
      x.resize(static_cast<std::size_t>(rows - by));
  });
}

void reverse(Log& log) {
  const double last = log.time.back(), first = log.time.front();
  std::reverse(log.time.begin(), log.time.end());
  for (double& t : log.time) t = first + last - t;
  for_each_value(log, [](Signal, std::vector<double>& x) { std::reverse(x.begin(), x.end()); });
}

// Whether a valve's answer could be seen in it.
bool is_sampled_as_a_valve_is(const Log& log) {
  const double duration = log.time.back() - log.time.front();
  return duration >= k::shortest_log && duration <= k::slowest_step * static_cast<double>(log.samples() - 1);
}

LogData ready(const Log& log, const ReadingTrial& trial) {
  LogData data = prepare_at_points(log, trial.rig, recorder_of(trial.tuned));
  leave_out_unknown_channels(data, trial.error);
  return data;
}

// By how much the sensors lag behind their simulation: where the moves of both are most alike. [s]
double lag_of(const LogData& data, const Trajectory& healthy) {
  const std::vector<double>& t = data.scenario.time;
  const double step = (t.back() - t.front()) / static_cast<double>(t.size() - 1);
  const auto stride = static_cast<std::size_t>(std::max(1L, std::lround(k::lag_step / step)));
  const auto half = static_cast<std::size_t>(std::max(1L, std::lround(k::block / step)));
  const auto changes = [&](const std::vector<double>& x) {
    std::vector<double> out;
    for (std::size_t i = 0; i + half < x.size(); i += stride) out.push_back(x[i + half] - x[i]);
    return out;
  };
  std::vector<std::array<std::vector<double>, 2>> pairs;
  for (const FitChannel& c : data.channels)
    pairs.push_back({changes(c.measured), changes(c.shown(healthy.signals[static_cast<std::size_t>(c.simulated)]))});
  const auto most = static_cast<long>(k::longest_lag / (step * static_cast<double>(stride)));
  double best = 0;
  long at = 0;
  for (long lag = -most; lag <= most; ++lag) {
    double sum = 0;
    for (const auto& [measured, simulated] : pairs) {
      const auto& late = lag > 0 ? measured : simulated;
      const auto& early = lag > 0 ? simulated : measured;
      const auto by = static_cast<std::size_t>(std::abs(lag));
      if (by < late.size()) sum += correlation({late.begin() + static_cast<long>(by), late.end()}, early);
    }
    if (sum > best) best = sum, at = lag;
  }
  return static_cast<double>(at) * step * static_cast<double>(stride);
}

}  // namespace

Log read_as(const Log& log, const Reading& reading) {
  Log out = log;
  switch (reading.kind) {
    case Misreading::time_scale:
      for (double& t : out.time) t *= reading.factor;
      break;
    case Misreading::reversed:
      reverse(out);
      break;
    case Misreading::late:
      delay(out, reading.factor);
      break;
    case Misreading::turned:
    case Misreading::unit:
      for (const Signal s : reading.of)
        for (double& x : out.channels[index(s)].value) x *= reading.factor;
      break;
    case Misreading::exchanged:
      for (std::size_t i = 0; i < reading.of.size(); ++i)
        out.channels[index(reading.of[i])].value = log.channels[index(reading.from[i])].value;
      break;
  }
  return out;
}

double left_as_read(const Log& log, const ReadingTrial& trial) {
  if (!is_sampled_as_a_valve_is(log)) return 1;
  const LogData data = ready(log, trial);
  // No driver gives that. A spool without its wire moves as if it were given: from stop to stop.
  if (asks_too_much(data.scenario)) return 1;
  const Trajectory healthy = reference_of(data, candidate_of(trial.tuned), trial.threads);
  return mean_left(motion_left(data, healthy, healthy), 1);
}

std::optional<Reading> best_reading(const Log& log, Unjudgeable unjudgeable, const ReadingTrial& trial) {
  std::vector<Reading> all = readings_of(log, unjudgeable);
  if (unjudgeable == Unjudgeable::no) {
    const LogData data = ready(log, trial);
    const Trajectory healthy = reference_of(data, candidate_of(trial.tuned), trial.threads);
    const double lag = healthy.ok ? lag_of(data, healthy) : 0;
    if (std::abs(lag) >= k::worth_a_lag) all.push_back({Misreading::late, lag, held(log, sensors)});
  }
  side_by_side(static_cast<int>(all.size()), trial.threads, [&](int i, int threads) {
    Reading& each = all[static_cast<std::size_t>(i)];
    each.left = left_as_read(read_as(log, each), {trial.tuned, trial.rig, trial.error, threads});
  });
  const auto best = std::min_element(all.begin(), all.end(), [](auto& a, auto& b) { return a.left < b.left; });
  return best == all.end() ? std::nullopt : std::optional(*best);
}

}  // namespace servodx
