// Where the flow through an open metering edge turns from laminar to turbulent. The base model takes the value that
// theory gives for a sharp slot, C_d = delta sqrt(Re) with delta = 0.157 (Merritt 1967, sec. 3-4); rounded corners,
// burrs and passages behind the edge move it. The laminar part costs an open edge a flow that grows with viscosity and
// hardly with the opening: it acts like a lap that is wider in the cold. How fast the coefficient then meets its limit
// differs as well: as 1/Re where both drops add, as 1/Re^2 by the law of Borutzky, Barnard and Thoma (2002), which real
// orifices are near to (Wu, Burton, Schoenau 2002). Sharper still, the coefficient overshoots its limit on the way, as
// measured ones do by up to a tenth (the same; Merritt 1967, sec. 3-4): at 2 by 6 %. Simulation tools let the
// coefficient saturate as the hyperbolic tangent of the flow number, without a tail and without an overshoot: there the
// laminar drop fades as the turbulent one outgrows it. Bounds of Re: delta from 0.031 to 0.43. A tangent whose flow
// number turns at 1000 has Re 330, and McCloy and Martin (1980) give 260 for spool valves; 400 leaves room above both.
#pragma once
#include "effects/effect.h"
#include "model/constants.h"

namespace servodx {

struct EdgeTransition {
  static constexpr const char* name = "edge_transition";
  static constexpr const char* place = "metering";
  static constexpr const char* meaning =
      "the flow through the edges turns turbulent elsewhere than through a sharp slot";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test =
      "slow triangles of some per cent in cold and in hot oil: in the cold the piston lags by a wider lap";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 3;
  // Re_t = (C_d / delta)^2 with Re of the hydraulic diameter, twice the opening.
  static constexpr double per_length = 48.0 * constants::cd_metering * constants::cd_metering;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"transition_reynolds", "-", per_length* constants::slot_resistance, 2.0, 400.0, 30.0,
       "Reynolds number, of twice the opening, at which laminar and turbulent drop are alike"},
      {"transition_abruptness", "-", 0.0, 0.0, 2.0, 0.5,
       "0: the two drops add; 1: the flow is turbulent as soon as that drop is the larger; 2: it overshoots by 6 %"},
      {"transition_fading", "-", 0.0, 0.0, 2.0, 0.5,
       "0: the laminar drop stays; above, it fades as the turbulent one outgrows it: 0.4 saturates as a tangent does"},
  };
  // [-] added to the creeping-flow length of an open edge, in openings; q: own parameters.
  template <class T>
  static T edge_creep(const T* q) {
    return (q[0] - T(parameters[0].off)) * T(1.0 / per_length);
  }
  template <class T>
  static T edge_abruptness(const T* q) {
    return q[1];
  }
  template <class T>
  static T edge_fading(const T* q) {
    return q[2];
  }
};

}  // namespace servodx
