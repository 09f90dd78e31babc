#include "rig/fluid.h"

namespace servodx::rig {

double kinematic_viscosity(double at_40, double at_100, double temperature) {
  const auto z = [](double nu) { return std::log10(std::log10(nu * 1e6 + 0.7)); };
  const double t40 = std::log10(40.0 + zero_celsius), t100 = std::log10(100.0 + zero_celsius);
  const double slope = (z(at_40) - z(at_100)) / (t100 - t40);
  const double level = z(at_40) - slope * (std::log10(temperature) - t40);
  return (std::pow(10.0, std::pow(10.0, level)) - 0.7) * 1e-6;
}

Oil::Oil(const RigModel& m, double temperature, double air, double thickness)
    : density(m.oil_density * (1.0 - m.oil_expansion * (temperature - zero_celsius - 20.0))),
      viscosity(thickness * density * kinematic_viscosity(m.oil_viscosity_40, m.oil_viscosity_100, temperature)),
      viscosity_rise(m.oil_viscosity_pressure),
      inverse_beta(std::exp(m.oil_bulk_temperature * (temperature - zero_celsius - 40.0)) / m.oil_bulk_modulus),
      beta_rise(m.oil_bulk_pressure),
      air_fraction(air) {}

}  // namespace servodx::rig
