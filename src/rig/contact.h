// Contacts and friction of the rig.
//
// Friction: LuGre (Canudas de Wit, Olsson, Astrom & Lischinsky 1995): bristle deflection z [m],
//   dz/dt = v - sigma0 |v| z / g(v),  F = sigma0 z + sigma1 dz/dt + viscous v,
//   g(v) = Fc + (Fs - Fc) / (1 + (v/vs)^2)   (Lorentzian Stribeck curve of Hess & Soom 1990).
// sigma1 fades with speed as 1/(1 + (v/vs)^2) so that the force stays dissipative (Olsson 1996).
//
// Stops: Hunt & Crossley (1975): F = k d (1 + e dd/dt), never pulling.
#pragma once
#include <algorithm>
#include <cmath>

namespace servodx::rig {

struct Friction {
  double coulomb, breakaway, stribeck_speed, stiffness, damping, viscous;

  struct Result {
    double force;  // [N] on the moving part, against v
    double rate;   // [m/s] dz/dt
  };
  Result at(double v, double z) const {
    const double vs2 = stribeck_speed * stribeck_speed;
    const double slow = vs2 / (vs2 + v * v);
    const double g = coulomb + (breakaway - coulomb) * slow;
    const double rate = v - stiffness * std::fabs(v) / g * z;
    return {stiffness * z + damping * slow * rate + viscous * v, rate};
  }
};

// Force [N] back from stops at +-`travel`; `loss` [s/m] is e.
inline double stop_force(double x, double v, double travel, double stiffness, double loss) {
  if (x > travel) return -std::max(0.0, stiffness * (x - travel) * (1.0 + loss * v));
  if (x < -travel) return std::max(0.0, stiffness * (-travel - x) * (1.0 - loss * v));
  return 0.0;
}

// What is left of a displacement after a clearance of total width `clearance` is taken up.
inline double beyond_clearance(double x, double clearance) {
  return x - std::clamp(x, -0.5 * clearance, 0.5 * clearance);
}

}  // namespace servodx::rig
