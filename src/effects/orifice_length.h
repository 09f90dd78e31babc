// Fixed orifices are short tubes: beside the head of their jet they lose a laminar drop along their length, which grows
// with the oil's viscosity. At Reynolds numbers of some thousand it hardly shows; in cold oil it takes a tenth and more
// of the pilot flow, and with it of the spool's greatest speed. Hagen-Poiseuille in series with the jet (Merritt 1967,
// sec. 3-4, short tubes; his entrance length is left out). Bounds: a drilled jewel to a capillary.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct OrificeLength {
  static constexpr const char* name = "orifice_length";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "the fixed orifices pass less in thick oil, as tubes of some length do";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "full steps in cold and in hot oil: in the cold the spool slews slower";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"orifice_slenderness", "-", 0.0, 0.0, 10.0, 1.0, "length of the fixed orifices over their diameter"},
  };
  // [diameters] q: own parameters.
  template <class T>
  static T orifice_length(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
