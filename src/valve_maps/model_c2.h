// Model C2: model A with the saturation behind the leakage.
//   P12 = sat((P_SR xS / x_SS - G_PQ QJ) / (1 + G_PQ C_LK), +-P_SR)
// Reaches the supply, with a corner where a valve has a bend; no water hammer.
#pragma once
#include <algorithm>

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ModelC2 {
  double per_travel, gain_ratio, leak_factor;  // as model A
  explicit ModelC2(const ValveNumbers& v)
      : per_travel(1.0 / v.saturation_travel), gain_ratio(v.gain_ratio()), leak_factor(1.0 / (1.0 + v.leak_share())) {}
  double operator()(double x_s, double q_j, double supply) const {
    const double free = (supply * (x_s * per_travel) - gain_ratio * q_j) * leak_factor;
    return std::max(-supply, std::min(supply, free));
  }
};

}  // namespace servodx::valve_maps
