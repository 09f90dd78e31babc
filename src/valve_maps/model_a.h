// Model A: the pressure gain follows the supply, and a leakage proportional to P12 adds to the flow.
//   P12 = (P_SR xS / x_SS - G_PQ QJ) / (1 + G_PQ C_LK)
// Does not saturate.
#pragma once
#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ModelA {
  double per_travel;   // [1/m] 1 / x_SS
  double gain_ratio;   // [Pa s/m3] G_PQ
  double leak_factor;  // [-] 1 / (1 + G_PQ C_LK)
  explicit ModelA(const ValveNumbers& v)
      : per_travel(1.0 / v.saturation_travel), gain_ratio(v.gain_ratio()), leak_factor(1.0 / (1.0 + v.leak_share())) {}
  double operator()(double x_s, double q_j, double supply) const {
    return (supply * (x_s * per_travel) - gain_ratio * q_j) * leak_factor;
  }
};

}  // namespace servodx::valve_maps
