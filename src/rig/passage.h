// Flow through a restriction, one law for all of them:
//   dp = mu R q + (rho K / f^2 + rho P) q |q|,   f = lambda / (lambda^4 + lambda_c^4)^(1/4),
// the discharge coefficient C_d = C_d_inf f being constant at high flow number lambda = (D_h/nu) sqrt(2 dp/rho) and
// proportional to it (C_d = delta sqrt(Re), lambda_c = C_d_inf/delta^2) at low: McCloy & Martin 1980, Merritt 1967
// sec. 3-4, delta = 0.157 for a slot and 0.2 for a round hole. lambda is taken at the whole pressure drop, which makes
// the law explicit; where the laminar part R (covered land, long bore) rules, f does not matter.
//   K = 1/(2 (C_d_inf A)^2), P further losses in series (drillings), R Hagen-Poiseuille or plane slot.
//
// A metering edge of opening y: two corners of radius r, a radial clearance c apart. Where they pass each other
// (y > -2 r) the gap is the distance between the two circles, b = sqrt((y + 2r)^2 + (c + 2r)^2) - 2r; beyond that the
// land covers L = -y - 2r with an annular gap c: laminar, 12 mu L / (w c^3) over 1 + 1.5 e^2 for eccentricity e.
//   C_d_inf runs from `round` to `sharp` as b grows past r, and rises by `aspect` from slit to square.
//   Jet angle from 21 deg (b = c) to that of the free jet (von Mises; Merritt fig. 5-12).
// Limits: no cavitation choking, no jet reattachment, ports of constant width, no leakage beside the ports.
#pragma once
#include <cmath>
#include <numbers>

#include "base/pack.h"
#include "rig/fluid.h"
#include "rig/rig_model.h"

namespace servodx::rig {

struct Restriction {
  double laminar = 0.0;     // [1/m3] R
  double transition = 0.0;  // [1/m3] lambda_c / (2 C_d_inf A D_h): mu times it is the creeping resistance
  double turbulent = 0.0;   // [1/m4] K
  double inertial = 0.0;    // [1/m4] P
};

// Volume flow [m3/s] at the mean pressure; odd in dp, smooth through zero. T: double, or four of them.
template <class T>
T flow_through(const T& laminar, const T& transition, const T& turbulent, const T& inertial, const T& mu, const T& rho,
               const T& dp) {
  using std::max;
  using std::sqrt;
  const T size = max(dp, -dp);
  const T r = mu * laminar, creep = mu * transition, creep2 = creep * creep, k = rho * turbulent * size;
  const T orifice = sqrt(k * k + creep2 * creep2) + rho * inertial * size;
  return (dp + dp) / (r + sqrt(r * r + T(4.0) * orifice));
}
inline double flow_through(const Restriction& r, double mu, double rho, double dp) {
  return flow_through(r.laminar, r.transition, r.turbulent, r.inertial, mu, rho, dp);
}

// Four side by side, for the vector unit.
using Four = Pack<4>;
inline Four four(double a, double b, double c, double d) { return Four(Four::Vector{a, b, c, d}); }
inline double sum(const Four& x) { return (x[0] + x[1]) + (x[2] + x[3]); }

struct Restrictions {
  Four laminar{0.0}, transition{0.0}, turbulent{0.0}, inertial{0.0};
  void set(int i, const Restriction& r) {
    laminar.set(i, r.laminar);
    transition.set(i, r.transition);
    turbulent.set(i, r.turbulent);
    inertial.set(i, r.inertial);
  }
};
struct FourFlows {
  Four volume;     // [m3/s] at the mean pressure
  Four reference;  // [m3/s] of reference oil
  Four density;    // [kg/m3]
};
inline FourFlows flows_through(const Restrictions& r, const Oil& oil, const Four& from, const Four& to) {
  const Four mean = Four(0.5) * (from + to), packing = oil.packing(mean);
  FourFlows f;
  f.density = Four(oil.reference_density()) * packing;
  f.volume =
      flow_through(r.laminar, r.transition, r.turbulent, r.inertial, oil.viscosity_at(mean), f.density, from - to);
  f.reference = f.volume * packing;
  return f;
}

inline constexpr double slot_flow_number = 25.0;  // lambda_c of a slot, 0.61 / 0.157^2
inline constexpr double hole_flow_number = 15.0;  // of a round hole, 0.61 / 0.2^2

inline Restriction orifice(double discharge, double area, double hydraulic_diameter, double critical) {
  const double effective = discharge * area;
  return {.transition = critical / (2.0 * effective * hydraulic_diameter), .turbulent = 0.5 / (effective * effective)};
}
inline constexpr Restriction closed{.laminar = 1e30};

Restriction fixed_orifice(double diameter, double length, double discharge);
Restriction drilling(double diameter, double length, double heads);
// From a drop [Pa] at a flow: its laminar part and the rest; mu and rho are those at which it is stated.
Restriction rated_drop(double laminar, double turbulent, double flow, double mu, double rho);

// Curtain between nozzle and flapper: coefficients at a gap of 1 m; all fall with powers of the gap.
struct Nozzle {
  Restriction unit;  // laminar falls with the cube of the gap, transition and turbulent with its square
  // `discharge` of the curtain, `land` outer over inner diameter, `left` the part of the curtain that dirt has left
  static Nozzle of(double diameter, double discharge, double land, double left);
  Restriction at(double gap) const {
    const double inverse = 1.0 / (gap > 1e-6 ? gap : 1e-6);  // the stops keep it open; a dented stop still leaves 1 um
    const double square = inverse * inverse;
    return {unit.laminar * square * inverse, unit.transition * square, unit.turbulent * square, unit.inertial};
  }
};

// Area that two circles of radii a and b share, their centres d apart.
double shared_area(double a, double b, double d);

enum EdgeName : int { edge_pa, edge_at, edge_pb, edge_bt };

// The four edges side by side, for the vector unit.
struct Edges {
  double width, per_slot_width, clearance, sharp, round, aspect_per_gap, free_jet_cosine;
  Four lap, radius;
  Four sense = four(1.0, -1.0, -1.0, 1.0);  // of the spool travel that opens
  double covered;                           // [1/m4] 12 / (w c^3 (1 + 1.5 e^2)): times L
  Restriction port;                         // drilling in series

  // `clearance_factor` and `corner_wear` [m] are what use has done to new edges.
  explicit Edges(const RigModel& m, double clearance_factor = 1.0, double corner_wear = 0.0);

  struct Shape {
    Four inverse_gap;   // [1/m] 1/b
    Four growth;        // [1] db/dy
    Four inverse_area;  // [1/m2] 1/(C_d_inf w b)
    Four cosine;        // of the jet angle
    Restrictions law;   // with the drillings
  };
  Shape at(double x_spool) const {
    const Four one(1.0);
    Shape s;
    const Four reach = sense * Four(x_spool) - lap + radius + radius;
    const Four apart = max(reach, Four(0.0)), land = apart - reach;
    const Four across = Four(clearance) + radius + radius;
    const Four centres = sqrt(apart * apart + across * across), b = centres - radius - radius;
    const Four discharge =
        (Four(sharp) + Four(round - sharp) * radius / (radius + b)) * (one + Four(aspect_per_gap) * b);
    s.inverse_gap = one / b;
    s.inverse_area = s.inverse_gap / (discharge * Four(width));
    s.growth = apart / centres;
    const Four narrow = Four(clearance) * s.inverse_gap;
    s.cosine = Four(free_jet_cosine) + Four(cosine_of_21_degrees - free_jet_cosine) * narrow * narrow;
    s.law.laminar = Four(port.laminar) + Four(covered) * land;
    s.law.transition = Four(0.25 * slot_flow_number) * s.inverse_area * (s.inverse_gap + Four(per_slot_width));
    s.law.turbulent = Four(0.5) * s.inverse_area * s.inverse_area;
    s.law.inertial = Four(port.inertial);
    return s;
  }

 private:
  static constexpr double cosine_of_21_degrees = 0.9336;
};

}  // namespace servodx::rig
