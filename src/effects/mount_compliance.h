// Compliance of the structure that holds the cylinder: its body, a mass on a spring with a loss (Kelvin-Voigt), gives
// way under the hydraulic force and rings. What the seals' friction and the stops do to it is left out. Without a mass
// it follows the force as fast as its loss lets it. Bounds: to 200 kg, a cylinder of some tonnes of force.
#pragma once
#include <tuple>

#include "effects/effect.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

struct MountCompliance {
  static constexpr const char* name = "mount_compliance";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the cylinder's body moves against a mount of finite stiffness";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr RowAlong along = {row::moving_mass, false};  // structure that gives way swings with the rod
  static constexpr const char* best_test = "steps into a stiff load: the body's resonance in the load pressure";
  static constexpr int n_states = 2;  // travel of the body, its velocity
  static constexpr int n_parameters = 3;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"mount_compliance", "m/N", 0.0, 0.0, 1e-6, 3e-8, "travel of the body per force"},
      {"mount_relaxation", "s", 2e-4, 2e-5, 5e-3, 2e-4, "damping over stiffness of the mount", false},
      {"mount_mass", "kg", 0.0, 0.0, 200.0, 10.0, "mass of the cylinder's body", false},
  };
  static constexpr double part_of_oil = 0.25;     // of the oil's compliance at mid-stroke: a sound mount is the stiffer
  static constexpr double least_period2 = 1e-10;  // [s2] of a body without mass, over (2 pi)^2: 16 kHz, above any log

  // What a rig of this size may have: a body as heavy as what moves, on a mount that gives way beside the oil. Between
  // two rigs either number differs by a hundred times. p: rows of the model.
  static void as_large_as_rig(double* own, const double* p) {
    const auto spring = [&](int area, int dead_volume) {
      return p[area] * p[area] / (p[dead_volume] + 0.5 * p[row::piston_stroke] * p[area]);
    };
    const double oil = p[row::bulk_modulus] * (spring(row::piston_area_a, row::dead_volume_a) +
                                               spring(row::piston_area_b, row::dead_volume_b));
    own[0] = part_of_oil / oil;
    own[1] = parameters[1].start;
    own[2] = p[row::moving_mass];
  }

  template <class V>
  static auto body_velocity(const V& view) {
    return view.template own_state<MountCompliance, 1>();
  }
  // m C v' = -x - C F - T v
  template <class V>
  static auto derivative(const V& view) {
    using T = typename V::Scalar;
    const auto force = pick<row::piston_area_a>(view.p) * view.template state<s_p_a>() -
                       pick<row::piston_area_b>(view.p) * view.template state<s_p_b>() +
                       hook_pressure_force(view, typename V::Effects{});
    const auto travel = view.template own_state<MountCompliance, 0>(), speed = body_velocity(view);
    const auto compliance = view.template own<MountCompliance, 0>();
    const auto rate = inverse(compliance * view.template own<MountCompliance, 2>() + T(least_period2));
    return std::make_tuple(speed,
                           -rate * (travel + compliance * force + view.template own<MountCompliance, 1>() * speed));
  }
  template <class T>
  static void at_rest(T* own, const T* y, const T* q, const T* p) {
    own[0] = -q[0] * (p[row::piston_area_a] * y[s_p_a] - p[row::piston_area_b] * y[s_p_b]);
    own[1] = T(0.0);
  }
};

}  // namespace servodx
