// Linear map: P12 = G_P (xS - QJ / G_Q), with the slope read at null for G_P: the formula knows no leakage.
// No saturation, no leakage, no dependence on the supply: valid near null at the supply the gains were measured at.
#pragma once
#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct Linear {
  double slope;           // [Pa/m]
  double slope_per_flow;  // [Pa s/m3]
  explicit Linear(const ValveNumbers& v) : slope(v.null_slope), slope_per_flow(v.null_slope / v.flow_gain) {}
  double operator()(double x_s, double q_j, double /*supply*/) const { return slope * x_s - slope_per_flow * q_j; }
};

}  // namespace servodx::valve_maps
