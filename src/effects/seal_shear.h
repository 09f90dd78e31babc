// How the piston's viscous friction follows the oil. The base model takes seals that ride on a film of their own
// making, which thickens with the root of the viscosity, so friction grows as that root does (Blok 1963; Nau 1999). Oil
// that is sheared in a gap of given height, as about the rod in its bearings, drags in proportion to its viscosity
// (Couette). The share that does so can be told where healthy logs were taken in cold and in warm oil, and decides what
// another oil does to the actuator. Off: none of it.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct SealShear {
  static constexpr const char* name = "seal_shear";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the piston's viscous friction grows faster with the oil's viscosity";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"seal_shear_share", "-", 0.0, 0.0, 1.0, 0.5,
       "share of the piston's viscous friction at 40 degC that grows in proportion to the viscosity"},
  };
  // [-] q: own parameters.
  template <class T>
  static T seal_shear(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
