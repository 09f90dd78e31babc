#include "explain/sensor_causes.h"

#include <cstddef>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "effects/effect.h"
#include "effects/flow_meter_lag.h"
#include "effects/mains_pickup.h"
#include "effects/row_effects.h"
#include "effects/sensor_response.h"
#include "explain/constants.h"
#include "explain/subject.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace tried = explain_constants::tried;

std::string place_of_sensor(Signal sensor) { return "sensor:" + std::string(info(sensor).name); }

Cause of_sensor(std::string effect, Signal sensor) {
  Cause cause = named(std::move(effect), place_of_sensor(sensor));
  cause.of_channel = info(sensor).name;
  return cause;
}

// Gain and lag of a sensor carry one name whichever file has them: that of the piston sensor's row.
const RowEffect& effect_of_row(int at) {
  for (const RowEffect& e : row_effects())
    for (int row : e.rows)
      if (row == at) return e;
  throw std::out_of_range("no row effect has this row");
}

// One number of one sensor.
void add_sensor(std::vector<SoughtCause>& to, const EffectInfo& e, int j, int shown_at, const RowEffect& known_as,
                const CauseFacts& facts) {
  const Signal signal = simulated_signals[static_cast<std::size_t>(shown_at)];
  if (!facts.compared.contains(signal)) return;
  const EffectParameter& p = e.parameters[static_cast<std::size_t>(j)];
  CauseNumber n{effect_value(e, static_cast<std::size_t>(j), facts.tuned), p.unit};
  const double move = p.start - p.off, v = n.value.start;
  n.sizes = sizes_within(n.value, {v + move, v - move, v + tried::larger * move});
  Cause cause = of_sensor(known_as.name, signal);
  cause.test = known_as.best_test;
  to.push_back(sought(std::move(cause), {n}));
}

// Lines of pick-up channels: a frequency each, and of each log cosine and sine, since the phase belongs to a log.
std::vector<CauseNumber> numbers_of_lines(const EffectInfo& e, const std::vector<int>& channels,
                                          const CauseFacts& facts) {
  const auto at = [](int j) { return static_cast<std::size_t>(j); };
  std::vector<CauseNumber> out;
  for (const int c : channels)
    out.push_back({effect_value(e, at(2 * MainsPickup::channels + c), facts.tuned), "Hz", false});
  for (std::size_t l = 0; l < facts.logs; ++l)
    for (const int c : channels)
      for (const int k : {2 * c, 2 * c + 1}) {
        out.push_back({effect_value(e, at(k), facts.tuned), e.parameters[at(k)].unit});
        out.back().value.log = static_cast<int>(l);
        out.back().sizes = {e.parameters[at(k)].start};
      }
  return out;
}

// Alternatives are frequencies; cosines and sines are tried together.
std::vector<std::vector<std::vector<double>>> probes_of_lines(const std::vector<CauseNumber>& numbers,
                                                              const std::optional<double>& stated_frequency) {
  std::vector<double> frequencies(std::begin(tried::grids), std::end(tried::grids));
  if (stated_frequency) frequencies = {*stated_frequency};
  std::vector<std::vector<std::vector<double>>> out;
  for (const double f : frequencies)
    for (const double off : {0.0, -tried::grid_off, tried::grid_off}) {
      std::vector<double> rest;
      for (const CauseNumber& n : numbers) rest.push_back(n.size ? n.value.start : f + off);
      std::vector<std::vector<double>>& together = out.emplace_back();
      for (std::size_t j = 0; j < numbers.size(); ++j) {
        if (!numbers[j].size) continue;
        together.push_back(rest);
        together.back()[j] += numbers[j].sizes.front();
      }
    }
  return out;
}

SoughtCause lines(Cause cause, const std::vector<int>& channels, const EffectInfo& pickup, const CauseFacts& facts) {
  cause.test = pickup.best_test;
  const std::vector<CauseNumber> numbers = numbers_of_lines(pickup, channels, facts);
  SoughtCause out = sought(std::move(cause), numbers);
  out.cause.probes = probes_of_lines(numbers, facts.mains_frequency);
  return out;
}

// A loop of the sensors' common ground: a line on each.
Cause of_ground(const std::string& pickup, const std::vector<Signal>& sensors, std::size_t logs) {
  Cause cause = named(pickup, place_of_sensor(sensors.front()));
  cause.family = "ground";
  for (const Signal s : sensors) cause.places.push_back(place_of_sensor(s));
  for (std::size_t l = 0; l < logs; ++l)
    for (const Signal s : sensors) cause.places.insert(cause.places.end(), 2, place_of_sensor(s));
  return cause;
}

}  // namespace

std::vector<SoughtCause> mains_causes(const EffectInfo& pickup, const CauseFacts& facts) {
  constexpr Signal signals[MainsPickup::sensors] = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                                    Signal::pressure_b};
  std::vector<SoughtCause> out;
  std::vector<int> channels;
  std::vector<Signal> sensors;
  for (int c = 0; c < MainsPickup::sensors; ++c) {
    if (!facts.compared.contains(signals[c])) continue;
    channels.push_back(c), sensors.push_back(signals[c]);
    out.push_back(lines(of_sensor(pickup.name, signals[c]), {c}, pickup, facts));
  }
  out.push_back(lines(named(pickup.name, "drive"), {MainsPickup::sensors}, pickup, facts));
  if (sensors.size() > 1) out.push_back(lines(of_ground(pickup.name, sensors, facts.logs), channels, pickup, facts));
  return out;
}

std::vector<SoughtCause> sensor_causes(const EffectInfo& response, const CauseFacts& facts) {
  std::vector<SoughtCause> out;
  for (int c = 0; c < SensorResponse::channels; ++c) {
    const int shown_at = SensorResponse::shown_at[c];
    add_sensor(out, response, 2 * c, shown_at, effect_of_row(row::position_sensor_gain), facts);
    add_sensor(out, response, 2 * c + 1, shown_at, effect_of_row(row::position_sensor_lag), facts);
  }
  return out;
}

std::vector<SoughtCause> flow_meter_causes(const EffectInfo& lag, const CauseFacts& facts) {
  std::vector<SoughtCause> out;
  for (int k = 0; k < FlowMeterLag::n_parameters; ++k)
    add_sensor(out, lag, k, FlowMeterLag::shown_at[k], effect_of_row(row::position_sensor_lag), facts);
  return out;
}

}  // namespace servodx
