// The rod cavity of a position sensor (LVDT) as a third chamber of the actuator: the sensor's core stands in a bore of
// the piston rod, open to chamber A through a restriction. As the piston extends the core leaves the bore, so the
// cavity grows with travel and is filled from A; its pressure acts on its own area in place of A's.
//
// Its area is part of the piston's area A: where the cavity fills at once its pressure is A's and nothing is added. The
// filling is laminar, stated as the time constant with the piston fully retracted (restriction and compliance of the
// oil there). Leaves out: free air in the cavity, friction of the core, cavities vented to return. Source: the third
// chamber of the GA fault-diagnosis paper's actuator; chambers after Merritt (1967), chapter 6.
#pragma once
#include <tuple>
#include <type_traits>

#include "base/smooth.h"
#include "effects/effect.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

struct RodCavity {
  static constexpr const char* name = "rod_cavity";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the position sensor's cavity in the rod is a third chamber, filled from A";
  static constexpr bool of_construction = true;
  static constexpr int n_states = 1;  // oil compressed into the cavity per length, area * pressure / bulk modulus [m2]
  static constexpr int n_parameters = 3;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"rod_cavity_area", "m2", 0.0, 0.0, 5e-4, 8e-5, "section of the sensor's core in the rod"},
      {"rod_cavity_end", "m", 0.02, 0.005, 0.2, 0.02, "length of the cavity with the piston retracted", false},
      {"rod_cavity_lag", "s", 2e-3, 1e-4, 5e-2, 2e-3, "time in which the retracted cavity fills", false},
  };
  static constexpr double shortest = 1e-3;  // [m] the end stop gives by less

  // Force of the cavity's pressure on the piston. [N]
  template <class V>
  static auto force(const V& view) {
    return pick<row::bulk_modulus>(view.p) * view.template own_state<RodCavity, 0>();
  }
  // Oil from chamber A into the cavity. [m3/s]
  template <class V>
  static auto filling(const V& view) {
    const auto per_force =
        view.template own<RodCavity, 1>() / (pick<row::bulk_modulus>(view.p) * view.template own<RodCavity, 2>());
    return per_force * (view.template own<RodCavity, 0>() * view.template state<s_p_a>() - force(view));
  }
  // Room that the core leaves. [m3/s]
  template <class V>
  static auto growth(const V& view) {
    return view.template own<RodCavity, 0>() *
           (view.template state<s_v_piston>() - hook_body_velocity(view, typename V::Effects{}));
  }

  // Chamber A does not feed the cavity's area by its own growth, but through the restriction.
  template <class V>
  static auto flow_a(const V& view) {
    return growth(view) - filling(view);
  }
  template <class V>
  static auto piston_force(const V& view) {
    return force(view) - view.template own<RodCavity, 0>() * view.template state<s_p_a>();
  }
  template <class V>
  static auto derivative(const V& view) {
    using T = typename V::Scalar;
    const auto length = soft_positive(view.template own<RodCavity, 1>() + T(0.5) * pick<row::piston_stroke>(view.p) +
                                          view.template state<s_x_piston>(),
                                      T(shortest));
    return std::make_tuple((filling(view) - growth(view)) / length);
  }
};

}  // namespace servodx
