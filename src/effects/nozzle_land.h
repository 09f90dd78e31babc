// A nozzle's face has a land: oil leaves the bore through a flat slot between it and the flapper, whose laminar drop is
// in series with the jet's head at the curtain. It grows with the oil's viscosity and with the cube of the gap as that
// closes, so thicker oil raises both pilot pressures and moves the spool's gain and null; sharp nozzles hardly have it.
// Poiseuille in a plane slot of the land's width and mean circumference (Merritt 1967, eq. 2-69; he asks for sharp
// nozzles in sec. 5-6). Left out: the pressure under the land, which adds to the nozzle's area. Bounds: sharp to half
// of a bore.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct NozzleLand {
  static constexpr const char* name = "nozzle_land";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "the nozzles pass less in thick oil, as faces of some width do";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test =
      "slow triangles in cold and in hot oil with pilot pressures: in the cold they rise";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"nozzle_land_width", "m", 0.0, 0.0, 2e-4, 5e-5, "width of a nozzle's face about its bore"},
  };
  // [m] q: own parameters.
  template <class T>
  static T nozzle_land(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
