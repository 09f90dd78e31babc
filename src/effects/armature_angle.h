// The torque motor's air gaps change as the armature turns: its gain grows with the square of the angle and its
// magnetic spring, which works against the flexure, stiffens (Merritt 1967, sec. 6-2, to second order in travel over
// air gap). A flapper that lies on its nozzle then stays there longer. The magnets are taken to cancel half of the
// flexure, as in valves that are stable without current. Leaves out saturation of the iron and unequal gaps.
#pragma once
#include "effects/effect.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

struct ArmatureAngle {
  static constexpr const char* name = "armature_angle";
  static constexpr const char* place = "first_stage";
  static constexpr const char* meaning = "gain and magnetic spring of the torque motor grow with the armature's angle";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "full steps both ways: how long the spool slews before it slows down";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"armature_travel", "-", 0.0, 0.0, 0.11, 0.03,
       "square of the armature's travel over its air gap, the flapper on a nozzle; motors stay below a third"},
  };

  template <class V>
  static auto flapper_force(const V& view) {
    using T = typename V::Scalar;
    const auto x = flapper_travel(view.template state<s_x_flapper>(), view.p);
    const auto torque = T(3.0) * pick<row::torque_motor_gain>(view.p) * view.template state<s_current>();
    const auto per_square =
        view.template own<ArmatureAngle, 0>() / (pick<row::nozzle_gap>(view.p) * pick<row::nozzle_gap>(view.p));
    return per_square * (x * x) * (torque + T(2.0) * pick<row::flapper_stiffness>(view.p) * x);
  }
};

}  // namespace servodx
