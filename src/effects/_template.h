// Copy this file to NAME.h and open it with the physics, its limits and its source. Here: drag of the spool that grows
// with the square of its speed, after a film that needs a time to build up. No such thing is claimed to exist.
//
// Not in the list of effects. docs/adding_an_effect.md has the steps, model/hooks.h all places with units and signs.
#pragma once
#include <tuple>
#include <type_traits>

#include "base/smooth.h"
#include "effects/effect.h"
#include "model/hooks.h"

namespace servodx {

struct EffectTemplate {
  static constexpr const char* name = "effect_template";  // group "effect:NAME" in tables
  static constexpr const char* place = "spool";  // drive, first_stage, spool, metering, flow_a, piston_force, ...
  static constexpr const char* meaning = "drag of the spool that grows with the square of its speed";
  static constexpr Freed freed = Freed::on_actuators;                        // by `tune`, unless told
  static constexpr const char* best_test = "fast strokes of several sizes";  // the input that shows it best
  static constexpr int n_states = 1;
  static constexpr int n_parameters = 2;
  // name, unit, off value, bounds, typical size where a search begins, meaning; false: does not switch the effect.
  // The off value of the one that switches it must leave the base model as it is.
  static constexpr EffectParameter parameters[n_parameters] = {
      {"template_drag", "N s2/m2", 0.0, 0.0, 100.0, 10.0, "drag per speed squared"},
      {"template_lag", "s", 1e-3, 1e-4, 1e-2, 1e-3, "time in which the film follows the speed", false},
  };
  static constexpr double speed_rounding = 1e-3;  // [m/s] a thousandth of the slew

  // A hook: what is added at its place. No `if` on data; the same line runs on packs and on dual numbers.
  template <class V>
  static auto spool_force(const V& view) {
    using T = typename V::Scalar;
    const auto v = view.template own_state<EffectTemplate, 0>();
    return -(view.template own<EffectTemplate, 0>() * (v * smooth_abs(v, T(speed_rounding))));
  }
  // One derivative for each own state.
  template <class V>
  static auto derivative(const V& view) {
    return std::make_tuple((view.template state<s_v_spool>() - view.template own_state<EffectTemplate, 0>()) /
                           view.template own<EffectTemplate, 1>());
  }
};

}  // namespace servodx
