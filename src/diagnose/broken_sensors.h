// What no healthy sensor does, seen in one log beside the simulation at the tuned values: it freezes, turns about,
// stays at a limit, or shows the other port's pressure. Nothing is learnt from other logs.
#pragma once
#include <vector>

#include "diagnose/flow_into_chambers.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "signals/signal.h"
#include "simulate/scenario.h"

namespace servodx {

enum class SensorFinding {
  frozen,         // it shows one value while the command moves and the simulation's sensor would
  turned,         // it moves against the simulation
  swapped_ports,  // each pressure follows the other's simulation
  clipped,        // it stays at one limit while the simulation goes on
};
struct BrokenSensor {
  SensorFinding finding = SensorFinding::frozen;
  Signal signal = Signal::spool_position;
};
// `healthy`: the simulation at the tuned values, with the log's channels.
std::vector<BrokenSensor> broken_sensors(const LogData& data, const Trajectory& healthy);

bool names_exchanged_ports(const std::vector<BrokenSensor>& found);
// Pressures that follow the other port's simulation are exchanged, unless the flow into the chambers says that they
// stand as they should: a load with its sign turned does the same.
std::vector<BrokenSensor> beside_flow(std::vector<BrokenSensor> found, Chambers by_flow);

}  // namespace servodx
