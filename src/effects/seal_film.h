// Speed at which the piston's seals come to slide on a film of oil: half of the breakaway friction above sliding
// (row 33) is gone there (Stribeck's curve; Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30, 1994). The base
// model takes an elastomer's; lip seals of low friction slide from some millimetres a second. Shapes row 33 alone.
#pragma once
#include "effects/effect.h"
#include "model/constants.h"

namespace servodx {

struct SealFilm {
  static constexpr const char* name = "seal_film";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the piston's seals come to slide on oil at another speed";
  static constexpr bool shapes_rows = true;  // means nothing without the row effect that lists it
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"seal_film_speed", "m/s", constants::piston_stribeck_velocity, 1e-3, 0.1, 8e-3,
       "piston speed at which half of the breakaway friction is gone"},
  };
  // [m/s] added to the base model's; q: own parameters.
  template <class T>
  static T seal_film_speed(const T* q) {
    return q[0] - T(parameters[0].off);
  }
};

}  // namespace servodx
