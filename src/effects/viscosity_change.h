// Another oil than the rig file's, or one that has changed: its viscosity is a multiple of what the fluid's law gives
// at the log's temperature. Shear thinning of the polymer in aircraft fluids takes half and more of it in service
// (SAE AIR 1362); a sensor of temperature far from the valve looks the same.
//
// Acts on all that is laminar: leakage of the covered edges and of the piston seal, shear of the spool, viscous
// friction of the piston. Density is left alone.
#pragma once
#include "effects/effect.h"
#include "model/state.h"

namespace servodx {

struct ViscosityChange {
  static constexpr const char* name = "viscosity_change";
  static constexpr const char* place = "metering";
  static constexpr const char* meaning = "the oil is thicker or thinner than its law says";
  static constexpr bool known_oil_only = true;  // elsewhere each log has a viscosity of its own
  static constexpr const char* best_test = "the same test in cold and in hot oil";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"viscosity_factor", "-", 1.0, 0.1, 10.0, 0.5, "viscosity over what the fluid's law gives"},
  };
  // Factor on the oil's viscosity; q: own parameters.
  template <class T>
  static T viscosity(const T* q, const Oil&) {
    return q[0];
  }
};

}  // namespace servodx
