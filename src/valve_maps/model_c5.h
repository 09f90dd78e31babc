// Model C5: the flow enters as an equivalent spool position, and the pressure gain fades with that.
//   x_St = xS - QJ G_PQ x_SS / max(P_SR, P_vap)
//   P12  = x_St P_SR / (max(|x_St|, x_SS) + G_PQ C_LK x_SS)
// Tends to P_SR and never reaches it: 0.83 P_SR at x_SS where G_PQ C_LK = 0.2. No water hammer.
#pragma once
#include <algorithm>
#include <cmath>

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ModelC5 {
  double flow_travel;        // [Pa s/m2] G_PQ x_SS
  double saturation_travel;  // [m]
  double leak_travel;        // [m] G_PQ C_LK x_SS
  double vapour_pressure;    // [Pa]
  explicit ModelC5(const ValveNumbers& v)
      : flow_travel(v.gain_ratio() * v.saturation_travel),
        saturation_travel(v.saturation_travel),
        leak_travel(v.leak_share() * v.saturation_travel),
        vapour_pressure(v.vapour_pressure) {}
  double operator()(double x_s, double q_j, double supply) const {
    const double x_st = x_s - q_j * flow_travel / std::max(supply, vapour_pressure);
    return x_st * supply / (std::max(std::fabs(x_st), saturation_travel) + leak_travel);
  }
};

}  // namespace servodx::valve_maps
