// Model C3: saturation ahead of a leakage that fades as the spool opens.
//   P12 = sat(P_SR xS / x_SS - G_PQ QJ, +-P_SR) / (1 + G_PQ C_LK x_SS / max(|xS|, x_SS))
// Our reading of the paper's leakage block with its limited spool displacement (the figure is lost): equal to C5 at
// QJ = 0, and, where QJ saturates it, dipping to P_SR / (1 + G_PQ C_LK) around xS = 0. That dip is the anomaly which
// the paper reports.
#pragma once
#include <algorithm>
#include <cmath>

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ModelC3 {
  double per_travel, gain_ratio, saturation_travel, leak_travel;  // leak_travel [m] G_PQ C_LK x_SS
  explicit ModelC3(const ValveNumbers& v)
      : per_travel(1.0 / v.saturation_travel),
        gain_ratio(v.gain_ratio()),
        saturation_travel(v.saturation_travel),
        leak_travel(v.leak_share() * v.saturation_travel) {}
  double operator()(double x_s, double q_j, double supply) const {
    const double free = supply * (x_s * per_travel) - gain_ratio * q_j;
    const double limited = std::max(std::fabs(x_s), saturation_travel);
    return std::max(-supply, std::min(supply, free)) * limited / (limited + leak_travel);
  }
};

}  // namespace servodx::valve_maps
