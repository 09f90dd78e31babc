// The pilot filter is a fine screen: part of its drop is laminar in the pores and grows with the oil's viscosity, the
// rest is inertial as in the base model. Hardly seen in warm oil, it takes the first stage's pressure in the cold, the
// more the more of the screen is blocked: pores act side by side, so the flow of each rises as the open area falls.
// Bounds: none, to a tenth of a usual supply pressure.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct ScreenDrop {
  static constexpr const char* name = "screen_drop";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "the pilot filter passes less in thick oil, as fine screens do";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "full steps in cold and in hot oil: in the cold the pilot pressures fall";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"screen_viscous_drop", "Pa", 0.0, 0.0, 2e6, 2e5,
       "laminar drop of the clean pilot filter at rest, in oil at 40 degC"},
  };
  // [Pa] q: own parameters.
  template <class T>
  static T screen_drop(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
