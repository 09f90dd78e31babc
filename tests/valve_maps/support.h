// Valves to judge maps on.
#pragma once
#include "servodx/valve_numbers.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/papers_valve.h"

namespace servodx::valve_maps {

inline constexpr double test_supply = 20.2e6;  // [Pa]

// The flight valve of params/borello2009.csv, 40 degC.
inline ValveGeometry flight_valve() {
  ValveGeometry g;
  g.port_width = 0.004992;
  g.radial_clearance = 3.5e-6;
  g.density = 848.0;
  g.dynamic_viscosity = 0.0119;
  g.return_pressure = 5e5;
  return g;
}

// The paper's case: G_PQ C_LK = 0.2.
inline ValveNumbers papers_numbers() {
  ValveNumbers v;
  v.supply = papers_supply;
  const double pressure_gain = v.supply / 1e-4;
  v.flow_gain = 0.5;
  v.leakage = papers_leak_share * v.flow_gain / pressure_gain;
  v.null_slope = pressure_gain / (1 + papers_leak_share);
  v.meet_slope();
  v.return_pressure = 5e5;
  v.null_leakage = v.leakage * v.supply;
  v.quarter_leakage = 0.4 * v.null_leakage;
  return v;
}

}  // namespace servodx::valve_maps
