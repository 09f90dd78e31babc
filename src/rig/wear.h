// What faults do to a rig: the physical quantities they move, at their healthy values by default.
#pragma once

namespace servodx::rig {

struct Wear {
  double filter_blocked = 0.0;  // [1] fraction of the screen's area
  double torque_gain = 1.0;     // [1] ampere turns left
  double coil_path = 1.0;  // [1] of the driver's voltage that reaches the coil; 0 open (of two parallel coils: one)
  double wire_clearance = 0.0;   // [m] total play of the ball
  double wire_stiffness = 1.0;   // [1] left
  double nozzle_blocked = 0.0;   // [1] fraction of nozzle 1, negative: of nozzle 2; a jet pipe has one jet
  double spool_friction = 1.0;   // [1] multiplier
  double spool_jam = 0.0;        // [N] by which a chip holds the spool, beside its friction
  double edge_clearance = 1.0;   // [1] multiplier of the radial clearance at the metering edges
  double corner_wear = 0.0;      // [m] on the radius of every metering corner
  double null = 0.0;             // [1] of rated current
  double piston_leakage = 0.0;   // [m3/s/Pa] across the piston at 40 degC, beside the healthy one
  double seal_friction = 1.0;    // [1] multiplier of the actuator's seal friction
  double supply_pressure = 1.0;  // [1] of the pump's cut-off pressure
  double position_gain = 1.0;    // [1] of the piston position sensor
};

}  // namespace servodx::rig
