// Torque motor: polarised magnetic bridge of permanent magnets, four air gaps and an armature (Merritt 1967, sec. 6-2;
// gap fluxes as measured by Urata 2007), with iron saturation, rate-independent hysteresis and eddy currents.
//   gaps:      R1 = Rg (1 - u), R2 = Rg (1 + u), u = arm * angle / gap;  phi1, phi2 the fluxes of the two diagonals
//   magnets:   M0 = Rm (phi1 + phi2) + R1 phi1 + R2 phi2
//   armature:  N i = R1 phi1 - R2 phi2 + iron(phi) + sigma dphi/dt,  phi = phi1 - phi2
//   torque:    arm (phi1^2 - phi2^2) / (mu0 A) over the two gaps of each diagonal = arm (phi1 + phi2) phi / (mu0 A)
// so gain and negative magnetic spring follow from geometry and magnets; they are not set.
//   iron(phi) = Ra phi (1 + (phi/phi_s)^4) + hysteresis
// Hysteresis: Prandtl-Ishlinskii, that is a Preisach operator made of `n` stop (elastic-slip) elements of equal height
// coercive/n whose limits are reached at flux swings hysteresis_flux (k/n)^2. The saturated loop is 2 coercive wide in
// ampere turns; small loops are narrower in proportion, as measured minor loops are. Its memory is committed once a
// step; inside a step it is a function of the flux change since the step's start.
// Limits: no leakage flux, one iron path, temperature-independent magnets, current driver (coil voltage not limited).
#pragma once
#include <algorithm>
#include <array>
#include <numbers>

#include "rig/rig_model.h"

namespace servodx::rig {

class Hysteresis {
 public:
  static constexpr int n = 6;
  Hysteresis(double coercive, double largest_flux) : limit_(coercive / n) {
    for (int k = 0; k < n; ++k) slope_[k] = limit_ / (largest_flux * (k + 1) * (k + 1) / (n * n));
  }
  // [A] at a flux `delta` [Wb] away from the last committed one
  double mmf(double delta) const {
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += std::clamp(held_[k] + slope_[k] * delta, -limit_, limit_);
    return sum;
  }
  void commit(double delta) {
    for (int k = 0; k < n; ++k) held_[k] = std::clamp(held_[k] + slope_[k] * delta, -limit_, limit_);
  }

 private:
  double limit_;                   // [A] of each element
  std::array<double, n> slope_{};  // [1/H]
  std::array<double, n> held_{};   // [A] demagnetised at first
};

struct Magnetics {
  double turns, gap_reluctance, magnet_mmf, magnet_reluctance, armature_reluctance, saturation, eddy, arm_over_gap,
      torque_factor;

  explicit Magnetics(const RigModel& m)
      : turns(m.motor_turns),
        gap_reluctance(m.motor_gap_length / (mu0 * m.motor_gap_area)),
        magnet_mmf(m.motor_magnet_mmf),
        magnet_reluctance(m.motor_magnet_reluctance),
        armature_reluctance(m.motor_armature_reluctance),
        saturation(m.motor_saturation_flux),
        eddy(m.motor_eddy_conductance),
        arm_over_gap(m.motor_arm / m.motor_gap_length),
        torque_factor(m.motor_arm / (mu0 * m.motor_gap_area)) {}

  struct Result {
    double torque;     // [N m] positive turns the flapper towards nozzle 1
    double flux_rate;  // [Wb/s]
  };
  // `mmf` [A] of the coils, `phi` [Wb] armature flux, `hysteresis` [A]
  Result at(double mmf, double phi, double angle, double hysteresis) const {
    const double u = arm_over_gap * angle;
    const double sum = (magnet_mmf + phi * gap_reluctance * u) / (magnet_reluctance + gap_reluctance);
    const double in_gaps = gap_reluctance * (phi - u * sum);
    const double s = phi / saturation, s2 = s * s;
    const double in_iron = armature_reluctance * phi * (1.0 + s2 * s2) + hysteresis;
    return {torque_factor * sum * phi, (mmf - in_gaps - in_iron) / eddy};
  }

 private:
  static constexpr double mu0 = 4e-7 * std::numbers::pi;  // [H/m]
};

}  // namespace servodx::rig
