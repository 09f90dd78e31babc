// How far each map is from HF, region by region, and what an evaluation costs.
//
// The grid is not the one that the numbers were read from (blocked ports and no load at full supply): load flows off
// both lines, travels to the stop, and supplies that have fallen. Points beyond three times P_SR are left out: lines
// would have burst. Regions by what HF says; near null is |xS| <= P_SR over the slope at null. The paper's own (section
// 2): linear "when the spool is close to the null position", saturated as it "moves further away", water hammer "when
// the valve is closed". The other two are open spools that its text leaves out.
//   linear        near null, |P12| <= 0.9 P_SR
//   saturated     |P12| above 0.9 P_SR and up to P_SR
//   water hammer  near null, |P12| > P_SR
//   open          beyond, |P12| <= 0.9 P_SR: pressure and flow trade against each other by the root
//   driven        beyond, |P12| > P_SR: a load pushes oil back through the open edge
#pragma once
#include <vector>

#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/registry.h"

namespace servodx::valve_maps {

Region region_of(double load_pressure, double x_s, double supply, const ValveNumbers& numbers);

struct CompareOptions {
  double stop = 5e-4;                                          // [m] largest travel
  std::vector<double> supply_shares = {1.0, 0.6, 0.25, 0.05};  // of P_SR
  bool costs = true;
};

std::vector<MapError> compare(const ValveNumbers& numbers, const HighFidelity& reference, const CompareOptions&);

// What a picture shows unless told: the null region with the bend to saturation, and flows that a shut valve answers
// with several times the supply.
double default_travel(const ValveNumbers& numbers);                                // [m]
double default_flow(const ValveNumbers& numbers);                                  // [m3/s]
std::vector<double> falling_supplies(double supply, const ValveNumbers& numbers);  // [Pa] down to P_vap

// Rows of travel, columns of flow, evenly spaced from -largest to +largest; both counts odd, so that zero is met.
std::vector<MapPoint> grid(const Map& map, double travel, int travels, double flow, int flows, double supply);

}  // namespace servodx::valve_maps
