// Dirt in one of the two nozzles: part of its curtain is blocked, and the pilot bridge is out of balance.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct NozzlePlugging {
  static constexpr const char* name = "nozzle_plugging";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "one nozzle is partly blocked";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"nozzle_1_blockage", "-", 0.0, 0.0, 0.98, 0.1,
       "blocked fraction of nozzle 1, which the flapper closes at positive current"},
      {"nozzle_2_blockage", "-", 0.0, 0.0, 0.98, 0.1, "blocked fraction of nozzle 2"},
  };
  // [-] q: own parameters.
  template <class T>
  static T nozzle_1_share(const T* q) {
    return -q[0];
  }
  template <class T>
  static T nozzle_2_share(const T* q) {
    return -q[1];
  }
};

}  // namespace servodx
