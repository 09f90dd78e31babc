#include "signals/rig_keys.h"

namespace servodx {
namespace {

using enum Dimension;

}  // namespace

const std::vector<RigFact>& rig_facts() {
  static const std::vector<RigFact> facts = {
      {"valve.rated_current", current, false},
      {"valve.dither.amplitude", current, true},
      {"valve.dither.frequency", frequency, false},
      {"valve.spool_stroke", length, false},
      {"valve.spool_stop", length, false},
      {"valve.spool_diameter", length, false},
      {"valve.land_length", length, false},
      {"valve.no_load_flow", flow, false},
      {"valve.rated_flow", flow, false},
      {"valve.rated_pressure_drop", pressure, false},
      {"valve.phase_lag_90_frequency", frequency, false},
      {"valve.step_rise_time", Dimension::time, false},
      {"valve.step_amplitude", fraction, false},
      {"valve.null_leakage", flow, true},
      {"valve.pilot_leakage", flow, true},
      {"valve.radial_clearance", length, false},
      {"valve.nozzle_diameter", length, false},
      {"valve.fixed_orifice_diameter", length, false},
      {"valve.nozzle_gap", length, false},
      {"valve.torque_motor_frequency", frequency, false},
      {"actuator.area_a", area, false},
      {"actuator.area_b", area, false},
      {"actuator.bore_diameter", length, false},
      {"actuator.rod_diameter_a", length, true},
      {"actuator.rod_diameter_b", length, true},
      {"actuator.stroke", length, false},
      {"actuator.moving_mass", mass, false},
      {"actuator.dead_volume_a", volume, false},
      {"actuator.dead_volume_b", volume, false},
      {"actuator.mount_stiffness", stiffness, false},
      {"lines.length", length, true},
      {"lines.bore", length, false},
      {"measurement.low_pass", frequency, false},
      {"supply.pressure", pressure, false},
      {"supply.return_pressure", pressure, true},
      {"fluid.density", density, false},
      {"fluid.kinematic_viscosity", kinematic_viscosity, false},
      {"fluid.kinematic_viscosity_100", kinematic_viscosity, false},
  };
  return facts;
}

const std::vector<LimitInfo>& limit_list() {
  static const std::vector<LimitInfo> list = {
      {"rated_flow", flow, false, "m3/s"},
      {"null_bias", fraction, true, "-"},
      {"hysteresis", fraction, true, "-"},
      {"threshold", fraction, true, "-"},
      {"linearity", fraction, true, "-"},
      {"symmetry", fraction, true, "-"},
      {"lap", fraction, true, "-"},
      {"pressure_gain", fraction, false, "1/%"},
      {"null_leakage", flow, true, "m3/s"},
      {"pilot_leakage", flow, true, "m3/s"},
      {"phase_lag_90_frequency", frequency, false, "Hz"},
      {"amplitude_3db_frequency", frequency, false, "Hz"},
  };
  return list;
}

}  // namespace servodx
