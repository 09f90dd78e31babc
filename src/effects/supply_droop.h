// Droop of the supply at the valve under the flow that the actuator draws: a source of finite resistance (lines, pump
// characteristic), filled up by what stands near the valve (accumulator, hoses) with a time constant.
//
// Flow drawn = mean piston area times speed: leakage and compression are left out. Moves the simulation only where
// supply_pressure is not measured; a measured one holds the droop, and the blocks' replay reads it there
// (explain/block_replay.h). Source: Merritt 1967, ch. 11 (supplies).
#pragma once
#include <tuple>

#include "base/smooth.h"
#include "effects/effect.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

struct SupplyDroop {
  static constexpr const char* name = "supply_droop";
  static constexpr const char* place = "supply";
  static constexpr const char* meaning = "the supply pressure at the valve falls with the flow drawn";
  static constexpr Freed freed = Freed::without_supply;
  static constexpr const char* best_test = "full steps with the supply pressure measured at the valve";
  static constexpr int n_states = 1;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"supply_resistance", "Pa s/m3", 0.0, 0.0, 6e10, 8e9, "droop per flow drawn"},
      {"supply_recovery", "s", 5e-3, 1e-3, 1.0, 5e-3, "time in which the droop follows the flow", false},
  };
  static constexpr double speed_rounding = 1e-3;  // [m/s] a third of a percent of no-load speed
  static constexpr double state_pressure = 1e8;   // [Pa] unit of the own state, the droop: a bar is 1e-3

  template <class V>
  static auto supply_pressure(const V& view) {
    using T = typename V::Scalar;
    return -(T(state_pressure) * view.template own_state<SupplyDroop, 0>());
  }
  template <class V>
  static auto derivative(const V& view) {
    using T = typename V::Scalar;
    const auto speed = smooth_abs(view.template state<s_v_piston>(), T(speed_rounding)) - T(speed_rounding);
    const auto area = T(0.5) * (pick<row::piston_area_a>(view.p) + pick<row::piston_area_b>(view.p));
    const auto steady = view.template own<SupplyDroop, 0>() * area * T(1.0 / state_pressure) * speed;
    return std::make_tuple((steady - view.template own_state<SupplyDroop, 0>()) / view.template own<SupplyDroop, 1>());
  }
};

}  // namespace servodx
