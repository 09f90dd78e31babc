// Linear map: P12 = G_P (xS - QJ / G_Q).
// No saturation, no leakage, no dependence on the supply: valid near null at the supply the gains were measured at.
#pragma once
#include "valve_maps/valve_numbers.h"

namespace servodx::valve_maps {

struct Linear {
  double pressure_gain;  // [Pa/m]
  double gain_ratio;     // [Pa s/m3]
  explicit Linear(const ValveNumbers& v) : pressure_gain(v.pressure_gain), gain_ratio(v.gain_ratio()) {}
  double operator()(double x_s, double q_j, double /*supply*/) const { return pressure_gain * x_s - gain_ratio * q_j; }
};

}  // namespace servodx::valve_maps
