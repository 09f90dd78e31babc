// The drop of the return line that the flow through the edges makes where the return pressure is not recorded.
// Turbulent, so in proportion to the square of that flow (Merritt 1967, sec. 3-3); only the edges to return feel it, in
// series with their own. What the pilot stage adds, and the line's inertia, are left out. A log that holds the return
// pressure holds the drop. Bounds: none, to as much as a fully open edge takes.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct ReturnDrop {
  static constexpr const char* name = "return_drop";
  static constexpr const char* place = "supply";
  static constexpr const char* meaning = "the return pressure rises with the flow";
  static constexpr bool as_made = true;  // the same in every log of a rig; a fault of it is seen by the return sensor
  static constexpr Freed freed = Freed::without_return;
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"return_drop_share", "-", 0.0, 0.0, 1.0, 0.05, "drop of the return line over that of an edge at full stroke"},
  };
  // [-] q: own parameters.
  template <class T>
  static T return_share(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
