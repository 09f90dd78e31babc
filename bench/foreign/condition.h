// In what state a rig is in one log: oil, null, a fault or an effect beyond its healthy behaviour. Faults and effects
// are changes of this struct, made in faults.cpp; machine and sensors read it.
#pragma once
#include <array>
#include <cmath>

#include "design.h"

namespace servodx::foreign {

struct Condition {
  double celsius = 40.0;
  double air = 0.005;  // [1] free at atmosphere
  double null = 0.0;   // [1] of rated current
  // faults
  double blocked_screen = 0.0;  // [1] of its area
  double torque = 1.0;          // [1] left
  double play = 0.0;            // [m] added at the ball
  double wire = 1.0;            // [1] left
  double spool_friction = 1.0;  // [1]
  double clearance = 1.0;       // [1]
  double blocked_nozzle = 0.0;  // [1] of nozzle 1
  double leak = 0.0;            // [m3/s/Pa] added across the piston
  double position_gain = 1.0;   // [1]
  double supply = 1.0;          // [1]
  // driver and sensors
  double driver = 1.0;             // [1] of the demand that the amplifier passes on
  double driver_limit = HUGE_VAL;  // [1] of rated current
  int sensor = -1;                 // the channel that is broken as follows; -1: none
  bool frozen = false;             // it shows what it showed at first
  double noise = 1.0;              // [1] of its noise
  // effects
  double delay = 0.0;                 // [s] of the command
  double hose = 0.0;                  // [m3/Pa] added at each chamber
  std::array<double, n_edges> lap{};  // [m] added
  double position_lag = 0.0;          // [s] added
  double pickup = 0.0;                // [1] of each channel's usual range, 50 Hz
  double mount = 0.0;                 // [N/m] in place of the design's; 0: the design's
  double stiction = 0.0;              // [N] of the spool, added to breaking away
  double hysteresis = 1.0;            // [1]
  double flow_force = 1.0;            // [1]
  double viscosity = 1.0;             // [1]
};

}  // namespace servodx::foreign
