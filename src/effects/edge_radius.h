// Corners of the metering edges, rounded by wear or by the making. An edge of radius r opens and closes over some r
// about its lap: the leakage at null and the pressure gain are those of blunt edges, the flow at large openings is not
// (Merritt, Hydraulic Control Systems, 1967, sec. 5.3; Borello 2009 lets the radius grow in service).
//
// Added to the rounding that the base model gives a new edge. One radius for the two edges from supply, one for the two
// to return, which other oil has worn; the model's smooth corner stands for the true arc, so that the numbers are those
// of a size, not of a measurement.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct EdgeRadius {
  static constexpr const char* name = "edge_radius";
  static constexpr const char* place = "metering";
  static constexpr const char* meaning = "the metering edges are blunt";
  static constexpr bool stand_only = true;  // an actuator shows its valve's edges through its own friction at null
  static constexpr Freed freed = Freed::everywhere;
  static constexpr const char* best_test =
      "the pressure's slope at null beside the leakage there: blunt edges leak more at the same slope";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"edge_radius", "m", 0.0, 0.0, 1e-4, 5e-6, "corner radius of the edges from supply above that of new ones"},
      {"return_edge_radius", "m", 0.0, 0.0, 1e-4, 5e-6, "corner radius of the edges to return above that of new ones"},
  };
  // [m] added to the rounding of the edges; q: own parameters.
  template <class T>
  static T edge_rounding(const T* q, bool to_return) {
    return q[to_return];
  }
};

}  // namespace servodx
