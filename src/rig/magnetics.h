// Torque motor: polarised magnetic bridge of permanent magnets, four air gaps and an armature (Merritt 1967, sec. 6-2;
// gap fluxes as measured by Urata 2007), with iron saturation, rate-independent hysteresis, eddy currents, and the coil
// that drives it.
//   gaps:      R1 = Rg (1 - u), R2 = Rg (1 + u), u = arm * angle / gap;  phi1, phi2 the fluxes of the two diagonals
//   magnets:   M0 = Rm (phi1 + phi2) + R1 phi1 + R2 phi2
//   armature:  N i = R1 phi1 - R2 phi2 + iron(phi) + sigma dphi/dt,  phi = phi1 - phi2
//   torque:    arm (phi1^2 - phi2^2) / (mu0 A) over the two gaps of each diagonal = arm (phi1 + phi2) phi / (mu0 A)
//   coil:      V = R i + N dphi/dt + L di/dt, L the leakage inductance alone: the rest is in dphi/dt, motion included
// so gain, inductance and negative magnetic spring follow from geometry and magnets; they are not set.
//   iron(phi) = Ra phi (1 + (phi/phi_s)^4) + hysteresis
// Hysteresis: a Preisach operator in flux, made of `n` stop (elastic-slip) elements of equal height coercive/n that
// turn over within swings hysteresis_flux (k/n)^2 of phi / sqrt(1 + (phi/phi_s)^2): minor loops keep their turning
// points, and loops close towards saturation (a generalised Prandtl-Ishlinskii operator, Al Janaideh, Rakheja & Su
// 2009). The loop of a full cycle is 2 coercive wide in ampere turns; small loops are narrower in proportion. Its
// memory is committed once a step; inside a step it is a function of the flux. Limits: no leakage flux of the magnets,
// one iron path, temperature-independent magnets.
#pragma once
#include <array>
#include <cmath>
#include <numbers>

#include "rig/rig_model.h"

namespace servodx::rig {

inline double limited(double x, double low, double high) { return x < low ? low : x > high ? high : x; }

class Hysteresis {
 public:
  static constexpr int n = 12;
  explicit Hysteresis(const RigModel& m)
      : Hysteresis(m.motor_coercive_mmf, m.motor_hysteresis_flux, m.motor_saturation_flux) {}
  Hysteresis(double coercive, double largest_flux, double saturation) : limit_(coercive / n), saturation_(saturation) {
    for (int k = 0; k < n; ++k) slope_[k] = 2.0 * limit_ / (largest_flux * (k + 1) * (k + 1) / (n * n));
  }
  double mmf(double flux) const {  // [A] at `flux` [Wb] on the way from the last committed one
    const double moved = swing(flux) - swing_;
    double sum = 0.0;
    for (int k = 0; k < n; ++k) sum += limited(held_[k] + slope_[k] * moved, -limit_, limit_);
    return sum;
  }
  void commit(double flux) {
    const double moved = swing(flux) - swing_;
    for (int k = 0; k < n; ++k) held_[k] = limited(held_[k] + slope_[k] * moved, -limit_, limit_);
    swing_ += moved;
  }

 private:
  double swing(double flux) const {
    const double s = flux / saturation_;
    return flux / std::sqrt(1.0 + s * s);
  }
  double limit_;                   // [A] of each element
  double saturation_;              // [Wb]
  double swing_ = 0.0;             // [Wb] committed
  std::array<double, n> slope_{};  // [1/H]
  std::array<double, n> held_{};   // [A] demagnetised at first
};

struct Magnetics {
  double turns, gap_reluctance, magnet_mmf, magnet_reluctance, armature_reluctance, saturation, eddy, arm_over_gap,
      torque_factor, inverse_saturation, inverse_eddy, inverse_reluctance;

  explicit Magnetics(const RigModel& m)
      : turns(m.working_turns()),
        gap_reluctance(m.motor_gap_length / (mu0 * m.motor_gap_area)),
        magnet_mmf(m.motor_magnet_mmf),
        magnet_reluctance(m.motor_magnet_reluctance),
        armature_reluctance(m.motor_armature_reluctance),
        saturation(m.motor_saturation_flux),
        eddy(m.motor_eddy_conductance),
        arm_over_gap(m.motor_arm / m.motor_gap_length),
        torque_factor(m.motor_arm / (mu0 * m.motor_gap_area)),
        inverse_saturation(1.0 / saturation),
        inverse_eddy(1.0 / eddy),
        inverse_reluctance(1.0 / (magnet_reluctance + gap_reluctance)) {}

  struct Result {
    double torque;     // [N m] positive turns the flapper towards nozzle 1
    double flux_rate;  // [Wb/s]
  };
  // `mmf` [A] of the coils, `phi` [Wb] armature flux, `hysteresis` [A]
  Result at(double mmf, double phi, double angle, double hysteresis) const {
    const double u = arm_over_gap * angle;
    const double sum = magnet_flux(phi, u);
    const double in_gaps = gap_reluctance * (phi - u * sum);
    const double s = phi * inverse_saturation, s2 = s * s;
    const double in_iron = armature_reluctance * phi * (1.0 + s2 * s2) + hysteresis;
    return {torque_factor * sum * phi, (mmf - in_gaps - in_iron) * inverse_eddy};
  }
  // Inductance [H] of the working turns at null, without the coils' leakage.
  double inductance() const { return turns * turns / (gap_reluctance + armature_reluctance); }
  // [J] of gaps, magnets and unhysteretic iron; its derivatives are the ampere turns and minus the torque.
  double energy(double phi, double angle) const {
    const double u = arm_over_gap * angle, sum = magnet_flux(phi, u);
    const double phi_1 = 0.5 * (sum + phi), phi_2 = 0.5 * (sum - phi);
    const double s = phi / saturation, s4 = s * s * s * s;
    return gap_reluctance * ((1.0 - u) * phi_1 * phi_1 + (1.0 + u) * phi_2 * phi_2) +
           0.5 * magnet_reluctance * sum * sum - magnet_mmf * sum + armature_reluctance * phi * phi * (0.5 + s4 / 6.0);
  }

 private:
  static constexpr double mu0 = 4e-7 * std::numbers::pi;  // [H/m]
  double magnet_flux(double phi, double u) const {        // [Wb] phi1 + phi2
    return (magnet_mmf + phi * gap_reluctance * u) * inverse_reluctance;
  }
};

}  // namespace servodx::rig
