// HF: the detailed map against which the simplified ones are judged. Four passages, each with its own overlap, solved
// for the two control pressures; oil cannot be drawn below its vapour pressure.
//
// A passage of overlap y < 0 or opening y > 0, corner radius r and radial clearance c (Merritt 1967, sec. 5-6; Borello
// et al. 2009, Fig. 3):
//   opening y+ = (y + sqrt(y^2 + r^2))/2, covered length y- = y+ - y, gap b = sqrt(y+^2 + c^2), area w b
//   laminar part: slot of the covered length, 12 mu y- / (w c^3 E) with E = 1 + 1.5 e^2 for an eccentric spool, and
//                 creeping flow through the gap, 32 mu / (pi w b^2) (Hasimoto 1958)
//   turbulent part: rho / (2 (Cd w b)^2); Cd falls from `discharge_round` to `discharge` as b grows past r
// Both in series make Cd depend on the Reynolds number. Limits: steady; no choking, no reattachment of the jet.
#pragma once
#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct ValveGeometry {
  double port_width = 0;                                  // [m] of each edge, all its ports
  double radial_clearance = 0;                            // [m]
  double lap_pa = 0, lap_pb = 0, lap_at = 0, lap_bt = 0;  // [m] overlap; negative is underlap
  double corner_radius = 1e-6;                            // [m] lapped edge
  double eccentricity = 0.3;                              // [-] spool in its sleeve: 0 centred, 1 touching
  double discharge = 0.62, discharge_round = 0.75;        // [-] sharp edge; opening small against its corner radius
  double density = 0;                                     // [kg/m3]
  double dynamic_viscosity = 0;                           // [Pa s]
  double return_pressure = 0;                             // [Pa] gauge
  double vapour_pressure = 1e3;                           // [Pa] absolute
};

class HighFidelity {
 public:
  explicit HighFidelity(const ValveGeometry& geometry);

  // [Pa] load pressure; x_s counts from the hydraulic null at the supply that the null was found at.
  double operator()(double x_s, double q_j, double supply) const;
  double no_load_flow(double x_s, double supply) const;  // [m3/s] with equal pressures at both ports
  double leakage(double x_s, double supply) const;       // [m3/s] supply to return, ports blocked
  double null() const { return null_; }                  // [m] hydraulic null from the geometric centre

  // What a test stand would read, at this supply less return. Moves the count of travel to the null found there.
  ValveNumbers measure(double supply);

 private:
  struct Side {
    double lap_supply, lap_return;  // [m]
  };
  double passage(double opening, double dp) const;  // [m3/s]
  // [Pa] above return of the port that the spool opens to supply by `x`, with `q` drawn from it.
  double port_pressure(const Side& side, double x, double q, double supply) const;
  ValveGeometry g_;
  Side a_, b_;
  double null_ = 0;
};

}  // namespace servodx::valve_maps
