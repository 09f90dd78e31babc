// Oil with free air at one temperature.
//   viscosity: Walther (ASTM D341) through two points, log10 log10(nu + 0.7) = A - B log10 T; with pressure Barus'
//              exponential to second order, 1 + a p + (a p)^2 / 2
//   density:   rho_20 (1 - alpha (T - 20 degC)) (1 + e - (m - 1)/2 e^2), the reciprocal of the liquid's v below
//   liquid:    v = 1 - e + (1 + m)/2 e^2, e = p/beta: tangent modulus beta + m p to second order in e
//   free air:  v_air = alpha_0 (p_0/p)^(3/4): polytropic exponent 4/3, between isothermal 1 and adiabatic 1.4,
//              the class of free-air formulas reviewed by Gholizadeh, Burton & Schoenau (2011), "Fluid bulk modulus:
//              a literature survey"
// A chamber of volume V holds V/v(p) of reference oil (oil at 0 gauge); that is what balances. Oil that enters at
// pressure p brings the enthalpy h(p) = integral of v dp a reference volume; a chamber holds u = h - p v.
// Limits: -40..100 degC, 0..50 MPa; no dissolving of air, no vapour, one temperature for the whole rig.
#pragma once
#include <cmath>

#include "base/celsius.h"
#include "rig/rig_model.h"

namespace servodx::rig {

inline constexpr double atmosphere = 101325.0;  // [Pa]

struct Oil {
  double density;         // [kg/m3] at zero gauge
  double viscosity;       // [Pa s] dynamic, at zero gauge
  double viscosity_rise;  // [1/Pa]
  double inverse_beta;    // [1/Pa] of the bulk modulus at zero gauge
  double beta_rise;       // [1]
  double air_fraction;    // [1] free air by volume at atmospheric pressure

  // `thickness`: viscosity over what the model's law says.
  Oil(const RigModel& m, double temperature, double air, double thickness = 1.0);

  // T: double, or several of them
  template <class T>
  struct Properties {
    T volume;    // [1] v
    T slope;     // [1/Pa] -dv/dp
    T enthalpy;  // [J/m3] h, of reference oil
  };
  template <class T>
  Properties<T> at(const T& gauge) const {
    using std::max;
    using std::sqrt;
    const T absolute = max(gauge + T(atmosphere), T(100.0));
    const T e = gauge * T(inverse_beta), rise(1.0 + beta_rise), one(1.0);
    const T thin = T(atmosphere) / absolute, root = sqrt(thin), fourth = sqrt(root);
    const T air = T(air_fraction) * root * fourth, liquid(1.0 - air_fraction);
    return {liquid * (one - e + T(0.5) * rise * e * e) + air,
            liquid * (one - rise * e) * T(inverse_beta) + T(0.75 / atmosphere) * air * thin,
            liquid * gauge * (one - e * (T(0.5) - T(1.0 / 6.0) * rise * e)) + T(4.0) * air * absolute};
  }
  // Of flowing oil, whose bubbles take no room at its pressures: [Pa s]; reference oil in a volume of it [1], which
  // carries its air along; the mass of reference oil [kg/m3].
  template <class T>
  T viscosity_at(const T& gauge) const {
    const T thick = T(viscosity_rise) * gauge;
    return T(viscosity) * (T(1.0) + thick * (T(1.0) + T(0.5) * thick));
  }
  template <class T>
  T packing(const T& gauge) const {
    const T e = gauge * T(inverse_beta);
    return (T(1.0) + e * (T(1.0) - T(0.5 * (beta_rise - 1.0)) * e)) * T(1.0 / (1.0 - air_fraction));
  }
  double reference_density() const { return density * (1.0 - air_fraction); }
  double stored(double gauge, double volume) const { return volume / at(gauge).volume; }  // [m3] reference oil
  double energy(double gauge, double volume) const {                                      // [J] of a chamber
    const auto p = at(gauge);
    return volume / p.volume * (p.enthalpy - gauge * p.volume);
  }
};

double kinematic_viscosity(double at_40, double at_100, double temperature);  // [m2/s], temperature [K]

}  // namespace servodx::rig
