// Flow through a restriction: a viscous and an inertial pressure loss in series, solved for the flow,
//   dp = R q + K q |q|.
// Together they are a discharge coefficient against Reynolds number: C_d -> constant when K rules, C_d ~ Re when R
// rules. Adding the creeping-flow and the inertial loss is Dagan, Weinbaum & Pfeffer (1982, J. Fluid Mech. 115).
// Creeping-flow losses: round hole 24 mu / d^3 (Sampson), slot 32 mu / (pi w b^2) (Hasimoto 1958), long bore
// 128 mu l / (pi d^4) (Hagen-Poiseuille), radial slot between discs 6 mu ln(Do/Di) / (pi g^3).
//
// A metering edge of overlap y < 0 and opening y > 0 has corners of radius r and a radial clearance c:
//   opening  y+ = (y + sqrt(y^2 + r^2))/2, covered length y- = (-y + sqrt(y^2 + r^2))/2 (a rounded corner is open and
//   covers by r/2 at zero lap), gap b = sqrt(y+^2 + c^2), so that the area is w b (Merritt 1967, sec. 5-6);
//   covered land: plane slot 12 mu y- / (w c^3) over the eccentricity factor 1 + 1.5 e^2.
//   C_d goes from `round` to `sharp` as b grows past r.
// Limits: no cavitation choking, no jet reattachment, ports of constant width, no leakage beside the ports.
#pragma once
#include <cmath>
#include <numbers>

#include "rig/fluid.h"

namespace servodx::rig {

struct Loss {
  double viscous = 0.0;   // [Pa s/m3] R
  double inertial = 0.0;  // [Pa s2/m6] K
};
inline Loss operator+(const Loss& a, const Loss& b) { return {a.viscous + b.viscous, a.inertial + b.inertial}; }

// Flow [m3/s] driven by dp [Pa]; odd in dp, smooth through zero.
inline double flow_through(const Loss& loss, double dp) {
  const double r = loss.viscous;
  return 2.0 * dp / (r + std::sqrt(r * r + 4.0 * loss.inertial * std::fabs(dp)));
}

inline double inertial_loss(double density, double discharge, double area) {
  const double effective = discharge * area;
  return 0.5 * density / (effective * effective);
}

Loss fixed_orifice(const Fluid& oil, double diameter, double length, double discharge);
Loss drilling(const Fluid& oil, double diameter, double length, double heads);
inline Loss rated_drop(double drop, double flow) { return {0.0, drop / (flow * flow)}; }

// Curtain between nozzle and flapper at `gap`.
struct Nozzle {
  double curtain;  // [m] pi d
  double discharge;
  double density;   // [kg/m3]
  double creeping;  // [Pa s m3/m3] R g^3
  Loss at(double gap) const {
    const double g = std::fmax(gap, 1e-6);  // the stops keep it open; a dented stop still leaves 1 um
    return {creeping / (g * g * g), inertial_loss(density, discharge, curtain * g)};
  }
};

struct Edge {
  double width, clearance, radius, sharp, round;
  double density;
  double slot;     // [Pa s/m] 32 mu / (pi w): over b^2
  double covered;  // [Pa s/m4] 12 mu / (w c^3 (1 + 1.5 e^2)): times y-
  Loss port;       // drilling in series

  Edge(const RigModel& m, const Fluid& oil, double clearance_factor);

  struct Flow {
    double q;         // [m3/s] from high to low
    double gap;       // [m] b
    double momentum;  // [N] rho q v of the jet at the edge, before the jet angle
    double growth;    // [1] db/dy
  };
  Flow flow(double opening, double dp) const {
    const double root = std::sqrt(opening * opening + radius * radius);
    const double open = 0.5 * (opening + root), cover = 0.5 * (root - opening);
    const double b2 = open * open + clearance * clearance, b = std::sqrt(b2);
    const double discharge = sharp + (round - sharp) * radius / (radius + b);
    const double area = discharge * width * b;
    const Loss edge{slot / b2 + covered * cover, 0.5 * density / (area * area)};
    const double q = flow_through(edge + port, dp);
    return {q, b, density * q * std::fabs(q) / area, open / b * open / root};
  }
};

}  // namespace servodx::rig
