// Stiction of the spool: what it takes to break away, above what it takes to keep sliding (silt, lacquer, a dry land).
// The asperities that hold the spool bear it as they bear Coulomb friction, and it falls away with speed (Stribeck
// 1902; Armstrong-Helouvry, Dupont & Canudas de Wit, Automatica 30, 1994). What holds more also yields further before
// it slips: contacts are as stiff as their load to the power of a third (Mindlin 1949), packed silt is softer than
// steel. Left out: growth with the time at rest.
#pragma once
#include <type_traits>

#include "effects/effect.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

struct Stiction {
  static constexpr const char* name = "stiction";
  static constexpr const char* place = "spool";
  static constexpr const char* meaning = "the spool breaks away at more than its sliding friction";
  static constexpr RowAlong along = {row::spool_friction, true};  // what sticks also drags: silt and lacquer
  static constexpr const char* best_test =
      "slow small triangle: the spool stands still at each reversal, longer the slower";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"stiction_force", "N", 0.0, 0.0, 60.0, 5.0, "breakaway force above Coulomb friction"},
      {"stiction_yield", "m", 0.0, 0.0, 1.5e-5, 3e-6, "way over which the spool yields before it slips, above steel's",
       true, false},
  };
  static constexpr double speed = 5e-3;  // [m/s] a spool at a hundredth of its slew is carried by its oil film

  // [m] added to the presliding of steel on steel; q: own parameters.
  template <class T>
  static T spool_yield(const T* q) {
    return q[1];
  }
  template <class V>
  static auto spool_force(const V& view) {
    using T = typename V::Scalar;
    const auto stretch =
        (view.template state<s_x_spool>() - view.u.friction.spool_anchor) * view.d.per_spool_presliding;
    return -((view.template own<Stiction, 0>() * stribeck(view.u.friction.spool_speed, T(1.0 / speed))) *
             asperities<T>(stretch));
  }
};

}  // namespace servodx
