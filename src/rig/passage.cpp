#include "rig/passage.h"

#include <algorithm>

#include "rig/rig_model.h"

namespace servodx::rig {
using std::numbers::pi;

Restriction fixed_orifice(double diameter, double length, double discharge) {
  Restriction r = orifice(discharge, pi / 4 * diameter * diameter, diameter, hole_flow_number);
  r.laminar = 128.0 * length / (pi * std::pow(diameter, 4));
  return r;
}

Restriction drilling(double diameter, double length, double heads) {
  const double area = pi / 4 * diameter * diameter;
  return {.laminar = 128.0 * length / (pi * std::pow(diameter, 4)), .inertial = 0.5 * heads / (area * area)};
}

Restriction rated_drop(double laminar, double turbulent, double flow, double mu, double rho) {
  return {.laminar = laminar / (mu * flow), .inertial = turbulent / (rho * flow * flow)};
}

double shared_area(double a, double b, double d) {
  if (d >= a + b) return 0.0;
  const double small = std::min(a, b);
  if (d <= std::fabs(a - b)) return pi * small * small;
  const double at_a = std::acos(std::clamp((d * d + a * a - b * b) / (2.0 * d * a), -1.0, 1.0));
  const double at_b = std::acos(std::clamp((d * d + b * b - a * a) / (2.0 * d * b), -1.0, 1.0));
  return a * a * (at_a - 0.5 * std::sin(2.0 * at_a)) + b * b * (at_b - 0.5 * std::sin(2.0 * at_b));
}

Nozzle Nozzle::of(double diameter, double discharge, double land, double left) {
  const double bore = pi / 4 * diameter * diameter;
  Nozzle n{orifice(discharge, pi * diameter * left, 2.0, slot_flow_number)};
  n.unit.laminar = 6.0 * std::log(land) / (pi * left);
  n.unit.inertial = 0.5 / (bore * bore);  // one velocity head of the bore
  return n;
}

Edges::Edges(const RigModel& m, double clearance_factor, double corner_wear)
    : width(m.edges_width),
      per_slot_width(m.edges_slots / m.edges_width),
      clearance(m.edges_clearance * clearance_factor),
      sharp(m.edges_discharge_sharp),
      round(m.edges_discharge_round),
      aspect_per_gap(m.edges_discharge_aspect * per_slot_width),
      free_jet_cosine(std::cos(m.spool_jet_angle * pi / 180.0)),
      lap(four(m.edges_lap_pa, m.edges_lap_at, m.edges_lap_pb, m.edges_lap_bt)),
      radius(four(m.edges_corner_pa, m.edges_corner_at, m.edges_corner_pb, m.edges_corner_bt) + Four(corner_wear)),
      covered(12.0 /
              (width * clearance * clearance * clearance * (1.0 + 1.5 * m.edges_eccentricity * m.edges_eccentricity))),
      port(drilling(m.edges_drilling_diameter, m.edges_drilling_length, m.edges_drilling_loss)) {}

}  // namespace servodx::rig
