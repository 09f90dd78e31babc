// Bridge: our closed form. The four edges of a matched valve as a bridge of laminar and turbulent resistances, solved
// exactly: it saturates, leaks, follows the supply with the root, and shows the water hammer. Derivation and limits:
// docs/valve_maps.md.
//
// For QJ >= 0 (else mirrored) edge 1 feeds the port that the load draws from, and edge 2 joins it to return; q_2 flows
// through edge 2 and q_2 + QJ through edge 1. Each edge drops R q + K q|q|, and both drops make up P_SR:
//   (K_1 +- K_2) q_2^2 + (R_1 + R_2 + 2 K_1 QJ) q_2 + (R_1 + K_1 QJ) QJ - P_SR = 0
// + while oil leaves to return, - where the load pulls it back out of return, which is the water hammer. With u = |xS|
// and the overlap L, one edge is open by u - L: R, K fall with h^2 = lambda^2 + (u - L)^2; the other is covered by
// u + L: its R grows with it. The equation is multiplied by h^2, so that one root and one division are all it takes.
// The port that is drawn from falls no lower than the oil's vapour pressure; the other port rises all the same.
//
// Limits: matched and symmetric edges; an underlap enters as null leakage only; steady; one oil temperature.
#pragma once
#include <algorithm>
#include <cmath>

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

struct Bridge {
  // An edge whose lap is just taken up: its resistances, and the opening lambda that would pass its turbulent flow
  // alone.
  double laminar;        // [Pa s/m3] R
  double laminar_cover;  // [Pa s/m4] growth of R per covered length
  double turbulent;      // [Pa s2/m6] K
  double null_height;    // [m] lambda
  double lap;            // [m] overlap, not negative
  double suction;        // [Pa] see ValveNumbers
  // The same in units in which lambda and K are one; pressures stay in Pa.
  double per_height, root_turbulent, lap_1, half_laminar, half_cover;
  explicit Bridge(const ValveNumbers& v);

  // No branch, one root, one division. Written for a short chain of dependent operations: in a simulation each
  // evaluation waits for the one before.
  double operator()(double x_s, double q_j, double supply) const {
    const double q = std::fabs(q_j) * root_turbulent;
    const double x = std::copysign(x_s * per_height, x_s * q_j);  // mirrored where the flow is
    const double y_1 = x - lap_1, y_2 = -x - lap_1;               // openings
    const double open_1 = std::max(y_1, 0.0), open_2 = std::max(y_2, 0.0);
    const double wider_1 = open_1 * open_1, wider_2 = open_2 * open_2;  // h^2 - 1
    // Half the laminar resistance of each edge as if it were not open.
    const double r_1 = half_laminar + half_cover * std::max(-y_1, 0.0);
    const double r_2 = half_laminar + half_cover * std::max(-y_2, 0.0);
    // Times the h^2 of both edges, one of which is 1.
    const double k_1 = 1.0 + wider_2, k_2 = 1.0 + wider_1, k_1_q = k_1 * q;
    const double c = supply * (k_1 + wider_1) - k_1_q * (q + (r_1 + r_1));
    const double b = (r_1 * k_1 + k_1_q) + r_2 * k_2;
    const double q_2 = c / (b + std::sqrt((b * b + k_1 * c) + k_2 * std::fabs(c)));
    // The drop at the covered edge needs no division by h^2.
    const double through = x > 0.0 ? q_2 : q_2 + q;
    const double drop = through * (2.0 * std::max(r_1, r_2) + std::fabs(through));
    const double above_return = x > 0.0 ? drop : supply - drop;
    return std::copysign(1.0, q_j) * (std::max(above_return, -suction) + (above_return - supply));
  }
};

}  // namespace servodx::valve_maps
