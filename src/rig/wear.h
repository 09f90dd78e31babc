// What faults do to a rig: the physical quantities they move, at their healthy values by default.
#pragma once

namespace servodx::rig {

struct Wear {
  double filter_blocked = 0.0;  // [1] fraction of the screen's area
  double torque_gain = 1.0;     // [1] ampere turns left
  double wire_clearance = 0.0;  // [m] total play of the ball
  double wire_stiffness = 1.0;  // [1] left
  double spool_friction = 1.0;  // [1] multiplier
  double edge_clearance = 1.0;  // [1] multiplier of the radial clearance at the metering edges
  double null = 0.0;            // [1] of rated current
};

}  // namespace servodx::rig
