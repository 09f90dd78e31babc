#include "rig/sensors.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "rig/plant.h"
#include "rig/rig_model.h"

namespace servodx::rig {

double rounded(double shown, double quantum) {
  if (quantum <= 0.0) return shown;
  // Multiples are formed by dividing by a whole number where 1/quantum is one, so that 3 * 0.1 is written 0.3.
  const double steps = std::round(shown / quantum), inverse = 1.0 / quantum, whole = std::round(inverse);
  const double value = std::fabs(inverse - whole) < 1e-9 * whole ? steps / whole : steps * quantum;
  return value == 0.0 ? 0.0 : value;  // no -0
}

SensorChain::SensorChain(const Sensor& sensor, std::uint64_t seed, std::uint32_t stream, double mains_frequency)
    : sensor_(sensor),
      signal_(*find_signal(sensor.signal)),
      unit_(find_unit(sensor.unit)),
      random_(seed, stream),
      mains_(2.0 * std::numbers::pi * mains_frequency),
      phase_(2.0 * std::numbers::pi * Random(seed, stream, 1).uniform()) {}

double SensorChain::truth(const VirtualRig& rig, const Seen& seen) const {
  const State& s = rig.state();
  switch (signal_) {
    case Signal::coil_current:
      return s[current];
    case Signal::spool_position:
      return s[x_spool];
    case Signal::piston_position:
      return rig.position_gain() * rig.piston_position();
    case Signal::pressure_a:
      return s[p_a];
    case Signal::pressure_b:
      return s[p_b];
    case Signal::supply_pressure:
      return s[p_supply];
    case Signal::return_pressure:
      return s[p_return];
    case Signal::pilot_pressure_1:
      return s[p_pilot_1];
    case Signal::pilot_pressure_2:
      return s[p_pilot_2];
    case Signal::load_pressure:
      return s[p_a] - s[p_b];
    case Signal::valve_pressure_drop:  // over the edges that carry the flow
      return s[p_supply] - s[p_return] - std::copysign(s[p_a] - s[p_b], s[x_spool]);
    case Signal::flow_a:
      return rig.last_flows().q_a;
    case Signal::flow_b:
      return rig.last_flows().q_b;
    case Signal::control_flow:  // a test stand's meter; on an actuator the mean of what enters and leaves it
      return rig.model().has_actuator() ? 0.5 * (rig.last_flows().q_a - rig.last_flows().q_b)
                                        : rig.last_flows().q_across;
    case Signal::leakage_flow:
      return rig.last_flows().q_return;
    case Signal::load_force:
      return seen.load_force;
    case Signal::oil_temperature:
      return seen.temperature;
    default:
      throw InputError({"", 0, "sensors." + sensor_.signal}, "the rig has no such sensor",
                       "remove it from the rig's [sensors]");
  }
}

void SensorChain::reset(const VirtualRig& rig, const Seen& seen) { input_ = output_ = truth(rig, seen); }

void SensorChain::follow(const VirtualRig& rig, const Seen& seen, double h) {
  time_ += h;
  if (h != h_) {
    h_ = h;
    keep_ = sensor_.lag > 0.0 ? std::exp(-h / sensor_.lag) : 0.0;
  }
  const double now = truth(rig, seen);
  output_ = sensor_.lag > 0.0 ? keep_ * output_ + (1.0 - keep_) * 0.5 * (input_ + now) : now;
  input_ = now;
}

double SensorChain::read() {
  double noisy = sensor_.gain * output_ + sensor_.offset + sensor_.noise * random_.normal();
  if (sensor_.pickup > 0.0) noisy += sensor_.pickup * std::sin(mains_ * time_ + phase_);
  return unit_->to_si(rounded(unit_->from_si(noisy), sensor_.quantum));
}

}  // namespace servodx::rig
