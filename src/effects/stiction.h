// Stiction of the spool: what it takes to break away, above what it takes to keep sliding (silt, lacquer, a dry land).
// The asperities that hold the spool bear it as they bear Coulomb friction, and it falls away with speed (Stribeck
// 1902; Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30, 1994). Left out: growth with the time at rest.
#pragma once
#include <type_traits>

#include "effects/effect.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/hooks.h"

namespace servodx {

struct Stiction {
  static constexpr const char* name = "stiction";
  static constexpr const char* place = "spool";
  static constexpr const char* meaning = "the spool breaks away at more than its sliding friction";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"stiction_force", "N", 0.0, 0.0, 60.0, 5.0, "breakaway force above Coulomb friction"},
  };
  static constexpr double speed = 5e-3;  // [m/s] a spool at a hundredth of its slew is carried by its oil film

  template <class V>
  static auto spool_force(const V& view) {
    using T = typename V::Scalar;
    const auto stretch =
        (view.template state<s_x_spool>() - view.u.friction.spool_anchor) * T(1.0 / constants::spool_presliding);
    return -((view.template own<Stiction, 0>() * stribeck(view.u.friction.spool_speed, T(1.0 / speed))) *
             asperities<T>(stretch));
  }
};

}  // namespace servodx
