#include "rig/passage.h"

namespace servodx::rig {
using std::numbers::pi;

Loss fixed_orifice(const Fluid& oil, double diameter, double length, double discharge) {
  const double d3 = diameter * diameter * diameter;
  return {24.0 * oil.viscosity / d3 + 128.0 * oil.viscosity * length / (pi * d3 * diameter),
          inertial_loss(oil.density, discharge, pi / 4 * diameter * diameter)};
}

Loss drilling(const Fluid& oil, double diameter, double length, double heads) {
  const double area = pi / 4 * diameter * diameter;
  return {128.0 * oil.viscosity * length / (pi * std::pow(diameter, 4)), heads * 0.5 * oil.density / (area * area)};
}

Edge::Edge(const RigModel& m, const Fluid& oil, double clearance_factor)
    : width(m.ports_width),
      clearance(m.ports_clearance * clearance_factor),
      radius(m.ports_corner_radius),
      sharp(m.ports_discharge_sharp),
      round(m.ports_discharge_round),
      density(oil.density),
      slot(32.0 * oil.viscosity / (pi * width)),
      covered(12.0 * oil.viscosity /
              (width * clearance * clearance * clearance * (1.0 + 1.5 * m.ports_eccentricity * m.ports_eccentricity))),
      port(drilling(oil, m.ports_drilling_diameter, m.ports_drilling_length, m.ports_drilling_loss)) {}

}  // namespace servodx::rig
