// How the piston's viscous friction follows the oil. The base model takes seals that ride on a film of their own
// making, which thickens with the root of the viscosity, so friction grows as that root does (Blok 1963; Nau 1999). Oil
// that is sheared in a gap of given height, as about the rod in its bearings, drags in proportion to its viscosity
// (Couette). What is lost in the seals' own material, and where they wipe the rod dry, grows with speed and not with
// the oil (Nau 1999). The shares can be told where healthy logs were taken in cold and in warm oil, and decide what
// another oil does to the actuator. Off: none of either. With both at one the friction still
// grows with the viscosity and is positive.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct SealShear {
  static constexpr const char* name = "seal_shear";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the piston's viscous friction follows the oil's viscosity more, or less";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "the same fast strokes in cold and in hot oil";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"seal_shear_share", "-", 0.0, 0.0, 1.0, 0.5,
       "share of the piston's viscous friction at 40 degC that grows in proportion to the viscosity"},
      {"seal_dry_share", "-", 0.0, 0.0, 1.0, 0.5,
       "share of the piston's viscous friction at 40 degC that the oil's viscosity leaves alone"},
  };
  // [-] q: own parameters.
  template <class T>
  static T seal_shear(const T* q) {
    return q[0];
  }
  template <class T>
  static T seal_dry(const T* q) {
    return q[1];
  }
};

}  // namespace servodx
