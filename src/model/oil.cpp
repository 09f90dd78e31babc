#include <cmath>

#include "base/celsius.h"
#include "model/state.h"

namespace servodx {

namespace {

constexpr double cool = reference_oil_temperature, hot = 373.15;  // [K] at which sheets state viscosities

double walther(double nu) { return std::log10(std::log10(nu * 1e6 + 0.7)); }

// Walther slope. Not known: 2.45 is MIL-PRF-5606 between 40 and 100 degC (13.5 and 5.1 mm2/s), 3.6 a mineral oil of
// viscosity index 100; aircraft fluids are the thin ones.
double walther_slope(double nu_40, double nu_100) {
  if (nu_100 > 0) return (walther(nu_40) - walther(nu_100)) / std::log10(hot / cool);
  constexpr double thin = 20e-6;  // [m2/s]
  return nu_40 < thin ? 2.45 : 3.6;
}

}  // namespace

Oil oil_at(double density_20, double kinematic_viscosity_40, double temperature_kelvin,
           double kinematic_viscosity_100) {
  const double slope = walther_slope(kinematic_viscosity_40, kinematic_viscosity_100);
  const double z = walther(kinematic_viscosity_40) - slope * (std::log10(temperature_kelvin) - std::log10(cool));
  const double nu = (std::pow(10.0, std::pow(10.0, z)) - 0.7) * 1e-6;
  Oil oil;
  oil.density = density_20 * (1.0 - 7e-4 * (temperature_kelvin - 293.15));  // thermal expansion of mineral oils
  oil.dynamic_viscosity = nu * oil.density;
  oil.viscosity_ratio = nu / kinematic_viscosity_40;
  oil.stiffness_ratio = std::pow(10.0, -0.0024 * (temperature_kelvin - cool));
  return oil;
}

}  // namespace servodx
