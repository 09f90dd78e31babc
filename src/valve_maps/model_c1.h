// Model C1: model A with the saturation ahead of the leakage.
//   P12 = sat(P_SR xS / x_SS - G_PQ QJ, +-P_SR) / (1 + G_PQ C_LK)
// The largest pressure is P_SR / (1 + G_PQ C_LK): too low for a valve that is open.
#pragma once
#include <algorithm>

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ModelC1 {
  double per_travel, gain_ratio, leak_factor;  // as model A
  explicit ModelC1(const ValveNumbers& v)
      : per_travel(1.0 / v.saturation_travel), gain_ratio(v.gain_ratio()), leak_factor(1.0 / (1.0 + v.leak_share())) {}
  double operator()(double x_s, double q_j, double supply) const {
    const double free = supply * (x_s * per_travel) - gain_ratio * q_j;
    return std::max(-supply, std::min(supply, free)) * leak_factor;
  }
};

}  // namespace servodx::valve_maps
