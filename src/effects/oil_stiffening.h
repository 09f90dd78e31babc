// Oil grows stiffer under pressure: the bulk modulus of mineral oils rises by 8 to 12 times the pressure (Hodges 1996,
// "Hydraulic Fluids"; Gholizadeh, Burton & Schoenau 2011). Row 38 is then its value at no pressure; at 280 bar it is a
// fifth more. Where a heavy load rings through that range, its frequency and its swing tell.
//
// Acts on the oil of the chambers. Pilot stage and manifold see little of it.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct OilStiffening {
  static constexpr const char* name = "oil_stiffening";
  static constexpr const char* place = "flow_a";
  static constexpr const char* meaning = "the oil grows stiffer under pressure";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool as_made = true;  // of the oil, and alike in all logs
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "full steps of a heavy load: it rings at high and at low pressure";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"stiffness_rise", "-", 0.0, 0.0, 20.0, 10.0, "rise of the oil's bulk modulus per pressure", true, true, 2.0},
  };
  // [-] q: own parameters.
  template <class T>
  static T stiffness_rise(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
