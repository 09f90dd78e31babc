// Compliance of the structure that holds the cylinder: its body gives way under the hydraulic force, with a loss that
// damps it (Kelvin-Voigt). The body's own mass is left out: valid well below the body's resonance.
#pragma once
#include <tuple>

#include "effects/effect.h"
#include "model/hooks.h"

namespace servodx {

struct MountCompliance {
  static constexpr const char* name = "mount_compliance";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the cylinder's body moves against a mount of finite stiffness";
  static constexpr int n_states = 1;
  static constexpr int n_parameters = 2;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"mount_compliance", "m/N", 0.0, 0.0, 3e-7, 3e-8, "travel of the body per force"},
      {"mount_relaxation", "s", 2e-4, 2e-5, 5e-3, 2e-4, "damping over stiffness of the mount", false},
  };

  // Velocity of the body: it relaxes towards the travel that the hydraulic force asks for.
  template <class V>
  static auto body_velocity(const V& view) {
    const auto& p = view.p;
    const auto force =
        p[row::piston_area_a] * view.template state<s_p_a>() - p[row::piston_area_b] * view.template state<s_p_b>();
    return -(view.template own_state<MountCompliance, 0>() + view.template own<MountCompliance>(0) * force) /
           view.template own<MountCompliance>(1);
  }
  template <class V>
  static auto derivative(const V& view) {
    return std::make_tuple(body_velocity(view));
  }
};

}  // namespace servodx
