#include "explain/sensor_causes.h"

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "effects/effect.h"
#include "effects/flow_meter_lag.h"
#include "effects/mains_pickup.h"
#include "effects/row_effects.h"
#include "effects/sensor_response.h"
#include "explain/subject.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

Cause of_sensor(std::string effect, Signal sensor) {
  const std::string channel(info(sensor).name);
  Cause cause = named(std::move(effect), "sensor:" + channel);
  cause.of_channel = channel;
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
  n.sizes = sizes_within(n.value, {v + move, v - move, v + 4 * move});
  Cause cause = of_sensor(known_as.name, signal);
  cause.test = known_as.best_test;
  to.push_back(sought(std::move(cause), {n}));
}

// The line of pick-up channel `c`: a frequency, and of each log cosine and sine, since the phase belongs to a log.
std::vector<CauseNumber> numbers_of_line(const EffectInfo& e, int c, const CauseFacts& facts) {
  const auto at = [](int j) { return static_cast<std::size_t>(j); };
  std::vector<CauseNumber> out = {{effect_value(e, at(2 * MainsPickup::channels + c), facts.tuned), "Hz", false}};
  for (std::size_t l = 0; l < facts.logs; ++l)
    for (int k : {2 * c, 2 * c + 1}) {
      out.push_back({effect_value(e, at(k), facts.tuned), e.parameters[at(k)].unit});
      out.back().value.log = static_cast<int>(l);
    }
  return out;
}

// Alternatives are frequencies; cosine and sine of all logs are tried together.
std::vector<std::vector<std::vector<double>>> probes_of_line(const std::vector<CauseNumber>& numbers, double size,
                                                             const std::optional<double>& stated_frequency) {
  std::vector<double> rest;
  for (const CauseNumber& n : numbers) rest.push_back(n.value.start);
  std::vector<double> frequencies = {50.0, 60.0};
  if (stated_frequency) frequencies = {*stated_frequency};
  std::vector<std::vector<std::vector<double>>> out;
  for (double f : frequencies)
    for (double off : {0.0, -0.15, 0.15}) {
      std::vector<std::vector<double>>& together = out.emplace_back();
      for (std::size_t j = 1; j < rest.size(); ++j) {
        std::vector<double>& probe = together.emplace_back(rest);
        probe[0] = f + off;
        probe[j] += size;
      }
    }
  return out;
}

}  // namespace

std::vector<SoughtCause> mains_causes(const EffectInfo& pickup, const CauseFacts& facts) {
  constexpr Signal signals[MainsPickup::sensors] = {Signal::spool_position, Signal::piston_position, Signal::pressure_a,
                                                    Signal::pressure_b};
  std::vector<SoughtCause> out;
  for (int c = 0; c < MainsPickup::channels; ++c) {
    const bool is_sensor = c < MainsPickup::sensors;
    if (is_sensor && !facts.compared.contains(signals[c])) continue;
    const std::vector<CauseNumber> numbers = numbers_of_line(pickup, c, facts);
    Cause cause = is_sensor ? of_sensor(pickup.name, signals[c]) : named(pickup.name, "drive");
    cause.test = pickup.best_test;
    SoughtCause& line = out.emplace_back(sought(std::move(cause), numbers));
    line.cause.probes =
        probes_of_line(numbers, pickup.parameters[static_cast<std::size_t>(2 * c)].start, facts.mains_frequency);
  }
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
