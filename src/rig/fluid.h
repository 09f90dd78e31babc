// Oil with free air at one temperature.
//   viscosity: Walther (ASTM D341) through two points, log10 log10(nu + 0.7) = A - B log10 T
//   density:   rho_20 (1 - alpha (T - 20 degC))
//   liquid:    v = 1 - e + (1 + m)/2 e^2, e = p/beta: tangent modulus beta + m p to second order in e
//   free air:  v_air = alpha_0 (p_0/p)^(3/4): polytropic exponent 4/3, between isothermal 1 and adiabatic 1.4,
//              the class of free-air formulas reviewed by Gholizadeh, Burton & Schoenau (2011), "Fluid bulk modulus:
//              a literature survey"
// A chamber of volume V holds V/v(p) of reference oil (oil at 0 gauge); that is what balances.
// Limits: -40..100 degC, 0..50 MPa; no dissolving of air, no vapour, no viscosity rise with pressure (about 20 % at
// 10 MPa), one temperature for the whole rig.
#pragma once
#include <cmath>

#include "rig/rig_model.h"

namespace servodx::rig {

inline constexpr double atmosphere = 101325.0;  // [Pa]
inline constexpr double zero_celsius = 273.15;  // [K]

struct Fluid {
  double density;       // [kg/m3] without air
  double viscosity;     // [Pa s] dynamic
  double beta;          // [Pa] bulk modulus at zero gauge
  double beta_rise;     // [1]
  double air_fraction;  // [1] free air by volume at atmospheric pressure

  Fluid(const RigModel& m, double temperature, double air);

  struct Specific {
    double volume;      // [1] over that of the liquid at zero gauge
    double compliance;  // [1/Pa] -dv/dp / v
  };
  Specific specific(double gauge) const {
    const double absolute = std::fmax(gauge + atmosphere, 100.0);
    const double e = gauge / beta;
    const double root = std::sqrt(atmosphere / absolute);
    const double air = air_fraction * root * std::sqrt(root);
    const double liquid = 1.0 - air_fraction;
    const double v = liquid * (1.0 - e + 0.5 * (1.0 + beta_rise) * e * e) + air;
    const double dv = liquid * (1.0 - (1.0 + beta_rise) * e) / beta + 0.75 * air / absolute;
    return {v, dv / v};
  }
  // dp/dt of a chamber: `volume` [m3], its growth [m3/s], net inflow of reference oil [m3/s].
  double pressure_rate(double gauge, double volume, double growth, double inflow) const {
    const Specific s = specific(gauge);
    return (inflow * s.volume - growth) / (volume * s.compliance);
  }
  double stored(double gauge, double volume) const { return volume / specific(gauge).volume; }  // [m3] reference oil
};

double kinematic_viscosity(double at_40, double at_100, double temperature);  // [m2/s], temperature [K]

}  // namespace servodx::rig
