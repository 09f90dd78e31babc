// Two nozzles are never quite alike: bores, edges and the fixed orifices before them differ by a few per cent, and one
// side passes more at the same gap. The flapper then stands off the middle at rest, which a null takes up, and the
// spool slews faster one way than the other, which no null does. Valves are made so: it does not come, so `explain`
// does not seek it. Bounds: bores that differ by a tenth.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct NozzleMismatch {
  static constexpr const char* name = "nozzle_mismatch";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "the two nozzles pass unlike flows at the same gap";
  static constexpr bool as_made = true;
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"nozzle_1_excess", "-", 0.0, -0.1, 0.1, 0.02, "what nozzle 1 passes beyond the mean of both, part of that mean"},
  };
  // [-] q: own parameters.
  template <class T>
  static T nozzle_1_share(const T* q) {
    return q[0];
  }
  template <class T>
  static T nozzle_2_share(const T* q) {
    return -q[0];
  }
};

}  // namespace servodx
