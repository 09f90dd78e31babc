// Oil in long lines between valve and cylinder. A metre of it weighs little, but the piston sees that mass times the
// square of the areas' ratio; and with pressure taps at the valve the drop along it stands between what is measured and
// what moves the piston (Merritt, Hydraulic Control Systems, 1967, ch. 3; Watton, Fluid Power Systems, 1989, lumped
// line).
//
// One lump a line: half of the walls' and the line's compliance (hose_compliance) stands at the valve, where the base
// states' pressures are, the other half with the chamber behind a mass of oil. States: flow in the line and pressure
// in the cylinder, for A and for B. Good up to about half of the line's first resonance; waves are left out, and so is
// what bends add to the laminar drop. The model's hose_resistance stays at the valve, ahead of the line.
//
// The pressures are measured somewhere along the line: between the valve's and the cylinder's in proportion to the
// place. At the cylinder the oil is a mass between the edges and what is measured.
#pragma once
#include <tuple>

#include "base/smooth.h"
#include "effects/effect.h"
#include "model/chamber.h"
#include "model/hooks.h"
#include "model/shown.h"
#include "model/state.h"
#include "parameters/list.h"

namespace servodx {

struct LineInertia {
  static constexpr const char* name = "line_inertia";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "oil in long lines between the valve and the cylinder";
  static constexpr Freed freed = Freed::with_long_lines;
  static constexpr const char* best_test =
      "fast steps with taps at the valve and at the cylinder: the two part by the piston's acceleration";
  static constexpr int n_states = 4;  // flow in line A, pressure of chamber A, the same of B
  static constexpr int n_parameters = 4;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"line_inertance", "kg/m4", 0.0, 0.0, 5e8, 1e7, "density times length over area of one line"},
      {"line_resistance", "Pa s/m3", 1e8, 0.0, 1e11, 1e8, "laminar drop along a line per flow, in oil at 40 degC",
       false},
      {"line_loss", "Pa s2/m6", 1e11, 0.0, 1e14, 1e11, "turbulent drop along a line per flow squared", false},
      {"line_tap", "-", 0.0, 0.0, 1.0, 0.5, "where along a line its pressure is measured: 0 the valve, 1 the cylinder",
       false},
  };
  // A tenth of a millimetre of line: keeps the equations finite while nothing of them acts.
  static constexpr double least_inertance = 1e3;  // [kg/m4]
  static constexpr double manifold = 2e-6;        // [m3] oil at the valve, beside the line's half
  static constexpr double half = 0.5;             // of the line's compliance, at either end
  static constexpr double flow_rounding = 1e-6;   // [m3/s] of the turbulent drop about no flow

  // 0 without the effect and 1 with it; half at a few millimetres of line, a part in ten thousand less than 1 at a
  // tenth of a line that matters. Level at 0: a fit that wants no line must see none there, nor a step beside it.
  template <class V>
  static auto acts(const V& view) {
    return part_on<typename V::Scalar>(view.template own<LineInertia, 0>());
  }
  template <class T, class X>
  static auto part_on(const X& inertance) {
    const auto square = inertance * inertance;
    return square * inverse(square + T(half_on * half_on));
  }
  static constexpr double half_on = 1e4;  // [kg/m4] a thousandth of a typical line's

  // Line S (0: A, 1: B).
  template <int S, class V>
  static auto line_flow(const V& view) {
    return view.template own_state<LineInertia, 2 * S>();
  }
  template <int S, class V>
  static auto chamber(const V& view) {
    return view.template own_state<LineInertia, 2 * S + 1>();
  }
  template <int S, class V>
  static auto tap(const V& view) {
    return view.template state < S == 0 ? s_p_a : s_p_b > ();
  }
  template <class V>
  static auto chamber_volume_a(const V& view) {
    return view.d.middle_volume_a + pick<row::piston_area_a>(view.p) * view.template state<s_x_piston>();
  }
  template <class V>
  static auto chamber_volume_b(const V& view) {
    return view.d.middle_volume_b - pick<row::piston_area_b>(view.p) * view.template state<s_x_piston>();
  }
  template <class V>
  static auto piston_speed(const V& view) {
    return view.template state<s_v_piston>() - hook_body_velocity(view, typename V::Effects{});
  }

  // At the tap stands the manifold in place of the chamber.
  template <class V>
  static auto volume_a(const V& view) {
    using T = typename V::Scalar;
    return acts(view) * (T(manifold) - chamber_volume_a(view));
  }
  template <class V>
  static auto volume_b(const V& view) {
    using T = typename V::Scalar;
    return acts(view) * (T(manifold) - chamber_volume_b(view));
  }
  template <class V>
  static auto wall_compliance(const V& view) {
    using T = typename V::Scalar;
    return acts(view) * (T(-half) * pick<row::hose_compliance>(view.p));
  }
  // What the piston and its leakage took from the tap, the line takes.
  template <class V>
  static auto flow_a(const V& view) {
    return acts(view) * (pick<row::piston_area_a>(view.p) * piston_speed(view) +
                         view.d.leak * (tap<0>(view) - tap<1>(view)) - line_flow<0>(view));
  }
  template <class V>
  static auto flow_b(const V& view) {
    return acts(view) * (-(pick<row::piston_area_b>(view.p) * piston_speed(view)) -
                         view.d.leak * (tap<0>(view) - tap<1>(view)) - line_flow<1>(view));
  }
  template <class V>
  static auto pressure_force(const V& view) {
    return acts(view) * (pick<row::piston_area_a>(view.p) * (chamber<0>(view) - tap<0>(view)) -
                         pick<row::piston_area_b>(view.p) * (chamber<1>(view) - tap<1>(view)));
  }

  // I dq/dt = p_tap - p_chamber - R q - K q|q|
  template <int S, class V>
  static auto line_rate(const V& view) {
    using T = typename V::Scalar;
    const auto q = line_flow<S>(view);
    const auto drop = view.template own<LineInertia, 1>() * view.d.viscosity_ratio * q +
                      view.template own<LineInertia, 2>() * (q * smooth_abs(q, T(flow_rounding)));
    return (tap<S>(view) - chamber<S>(view) - drop) * inverse(view.template own<LineInertia, 0>() + T(least_inertance));
  }
  template <class V>
  static auto derivative(const V& view) {
    using T = typename V::Scalar;
    const auto leak = view.d.leak * (chamber<0>(view) - chamber<1>(view));
    const auto walls = T(half) * pick<row::hose_compliance>(view.p);
    const auto v = piston_speed(view);
    return std::make_tuple(
        line_rate<0>(view),
        (line_flow<0>(view) - leak - pick<row::piston_area_a>(view.p) * v) *
            chamber_stiffness<typename V::Effects>(chamber_volume_a(view), walls, chamber<0>(view), view.d),
        line_rate<1>(view),
        (line_flow<1>(view) + leak + pick<row::piston_area_b>(view.p) * v) *
            chamber_stiffness<typename V::Effects>(chamber_volume_b(view), walls, chamber<1>(view), view.d));
  }
  template <class T>
  static void measured(T* out, const T* y, const T* own, const T* q) {
    const T along = part_on<T>(q[0]) * q[3];
    out[shown::pressure_a] = y[s_p_a] + along * (own[1] - y[s_p_a]);
    out[shown::pressure_b] = y[s_p_b] + along * (own[3] - y[s_p_b]);
  }
  // The lines carry what the piston sweeps.
  template <class T>
  static void at_rest(T* own, const T* y, const T*, const T* p) {
    own[0] = p[row::piston_area_a] * y[s_v_piston];
    own[1] = y[s_p_a];
    own[2] = -(p[row::piston_area_b] * y[s_v_piston]);
    own[3] = y[s_p_b];
  }
};

}  // namespace servodx
