// What a test stand would say of a virtual valve, measured by running it: flow curve with free ports, pressure gain and
// leakage with blocked ports, frequency and step response, and of the actuator speed and stall. Terms after SAE ARP490.
// Beside them the linear gains of the torque motor, which follow from its magnetic circuit and are set nowhere.
// All at 40 degC with 0.5 % free air. Pressure gain is taken from the metering edges at rest, where no flow remains.
#pragma once
#include <string>
#include <vector>

#include "rig/rig_model.h"

namespace servodx::rig {

struct Fact {
  std::string name, unit;
  double value;
};
std::vector<Fact> measure_facts(const RigModel& model);

struct FactLimit {
  std::string name, unit, source;
  double low, high;
};
// What params/rigs/valve_facts.csv says of a rig: rows of no rig hold for all, a row that names the rig (or the rig of
// which it is another valve) goes before them. Throws InputError.
std::vector<FactLimit> read_fact_limits(const std::string& path, const std::string& rig);

// Static torque [N m] of the motor without hysteresis.
double motor_torque(const RigModel& model, double current, double angle);
struct TorquePoint {
  double current, angle, torque;  // [A], [rad], [N m]
};
// From minus to plus rated current and from stop to stop of the flapper, 21 by 13 points.
std::vector<TorquePoint> torque_map(const RigModel& model);

}  // namespace servodx::rig
