// What no named effect explains, as a learnt curve: at one place of the model something is added that depends on one
// variable of it, by a smooth curve through seven knots.
//
//   added = factor * curve(s),   s = x / sqrt(x^2 + scale^2) in (-1, 1),   curve: the polynomial through the knots
//
// The knots stand at Chebyshev nodes of s: x = 0, +-0.48, +-1.25, +-4.4 times the scale, so the curve is finest about
// zero, where valves bend, and level far out. The factor is 1, or the load pressure over 100 bar (a leak), or the
// direction of the piston (a friction), or its velocity over 0.1 m/s (a brake). A description, not a law: it holds
// where the log that taught it has been. Leaves out: memory; curves of two variables other than through the factor.
#pragma once
#include <array>
#include <cmath>

#include "base/pack.h"
#include "base/smooth.h"
#include "effects/effect.h"
#include "model/hooks.h"
#include "parameters/list.h"

namespace servodx {

// Knots of the curve, and powers[j][k]: the coefficient of s^j in the polynomial that is 1 at knot k and 0 at the
// others.
namespace curve {
inline constexpr int knots = 7;
inline constexpr double node[knots] = {-0.9749279121818236, -0.7818314824680298, -0.4338837391175581, 0.0,
                                       0.4338837391175581,  0.7818314824680298,  0.9749279121818236};
constexpr std::array<std::array<double, knots>, knots> make_powers() {
  std::array<std::array<double, knots>, knots> m{};
  for (int k = 0; k < knots; ++k) {
    double c[knots + 1] = {1.0};
    int degree = 0;
    for (int i = 0; i < knots; ++i) {
      if (i == k) continue;
      const double by = 1.0 / (node[k] - node[i]);
      for (int j = ++degree; j >= 0; --j) c[j] = ((j > 0 ? c[j - 1] : 0.0) - (j < degree ? node[i] * c[j] : 0.0)) * by;
    }
    for (int j = 0; j < knots; ++j) m[j][k] = c[j];
  }
  return m;
}
inline constexpr auto powers = make_powers();
}  // namespace curve

struct Unexplained {
  static constexpr const char* name = "unexplained";
  static constexpr const char* place = "as its row curve_place says";
  static constexpr const char* meaning = "a learnt curve for what no named effect explains";
  static constexpr SoughtAs sought_as = SoughtAs::nothing;
  static constexpr int n_states = 0;
  static constexpr int knots = curve::knots;
  static constexpr int n_parameters = 4 + knots;

  // Codes of the first three parameters.
  enum Place { drive, spool, metering, at_a, at_b, piston, n_places };
  enum Variable {
    piston_position,
    piston_velocity,
    spool_position,
    spool_velocity,
    load_pressure,
    coil_current,
    n_variables
  };
  enum Factor { one, by_load_pressure, by_direction, by_velocity, n_factors };
  struct PlaceInfo {
    const char *where, *unit;
    double largest;  // [unit] bound of a knot
    double typical;  // [unit]
  };
  static constexpr PlaceInfo places[n_places] = {{"drive", "A", 0.01, 2e-4},     {"spool", "N", 100.0, 2.0},
                                                 {"metering", "m", 2e-4, 2e-6},  {"flow_a", "m3/s", 2e-4, 2e-6},
                                                 {"flow_b", "m3/s", 2e-4, 2e-6}, {"piston_force", "N", 3e4, 100.0}};
  struct VariableInfo {
    const char *name, *unit;
    double scale;  // [unit] the smallest that is of use
  };
  static constexpr VariableInfo variables[n_variables] = {
      {"piston_position", "m", 1e-3},  {"piston_velocity", "m/s", 2e-3}, {"spool_position", "m", 5e-6},
      {"spool_velocity", "m/s", 2e-3}, {"load_pressure", "Pa", 2e5},     {"coil_current", "A", 1e-4}};
  static constexpr const char* factors[n_factors] = {"", "load_pressure", "direction of the piston", "piston_velocity"};
  static constexpr double factor_pressure = 1e7;   // [Pa] load pressure at which the factor is 1
  static constexpr double factor_speed = 0.1;      // [m/s] velocity at which it is 1
  static constexpr double direction_speed = 2e-3;  // [m/s] rounding of the direction

  static constexpr EffectParameter parameters[n_parameters] = {
      {"curve_place", "-", 5, 0, n_places - 1, 5,
       "code of the place: drive, spool, metering, flow_a, flow_b, piston_force", false},
      {"curve_variable", "-", 1, 0, n_variables - 1, 1,
       "code of the variable: piston position, piston velocity, spool position, spool velocity, load pressure, current",
       false},
      {"curve_factor", "-", 0, 0, n_factors - 1, 0,
       "code of the factor: none, load pressure, direction of the piston, its velocity", false},
      {"curve_scale", "SI", 0.05, 1e-6, 1e9, 0.05, "scale of the variable", false},
      {"curve_knot_1", "SI", 0, -3e4, 3e4, -10, "curve at s = -0.975"},
      {"curve_knot_2", "SI", 0, -3e4, 3e4, -8, "curve at s = -0.782"},
      {"curve_knot_3", "SI", 0, -3e4, 3e4, -5, "curve at s = -0.434"},
      {"curve_knot_4", "SI", 0, -3e4, 3e4, 0, "curve at s = 0"},
      {"curve_knot_5", "SI", 0, -3e4, 3e4, 5, "curve at s = 0.434"},
      {"curve_knot_6", "SI", 0, -3e4, 3e4, 8, "curve at s = 0.782"},
      {"curve_knot_7", "SI", 0, -3e4, 3e4, 10, "curve at s = 0.975"},
  };

  // The codes are the same in all lanes of a pack.
  template <int Which, class V>
  static int code(const V& view) {
    return static_cast<int>(std::lround(Lanes<typename V::Scalar>::get(view.template own<Unexplained, Which>(), 0)));
  }
  // The curve where it belongs, zero elsewhere.
  template <class V>
  static auto at(const V& view, Place where) {
    using T = typename V::Scalar;
    const auto is = [](bool yes) { return T(yes ? 1.0 : 0.0); };
    const int variable = code<1>(view), factor = code<2>(view);
    const auto load = view.template state<s_p_a>() - view.template state<s_p_b>();
    const auto x = is(variable == piston_position) * view.template state<s_x_piston>() +
                   is(variable == piston_velocity) * view.template state<s_v_piston>() +
                   is(variable == spool_position) * view.template state<s_x_spool>() +
                   is(variable == spool_velocity) * view.template state<s_v_spool>() +
                   is(variable == load_pressure) * load +
                   is(variable == coil_current) * view.template state<s_current>();
    const auto s = x / smooth_abs(x, view.template own<Unexplained, 3>());
    T c[knots];
    for (int j = 0; j < knots; ++j) {
      c[j] = T(0.0);
      unroll<knots>([&](auto k) { c[j] = c[j] + T(curve::powers[j][k]) * view.template own<Unexplained, 4 + k>(); });
    }
    const auto curve = c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * (c[5] + s * c[6])))));
    const auto by = is(factor == one) + is(factor == by_load_pressure) * T(1.0 / factor_pressure) * load +
                    is(factor == by_direction) * smooth_sign(view.template state<s_v_piston>(), T(direction_speed)) +
                    is(factor == by_velocity) * T(1.0 / factor_speed) * view.template state<s_v_piston>();
    return is(code<0>(view) == where) * (by * curve);
  }

  template <class V>
  static auto flapper_force(const V& view) {
    return pick<row::torque_motor_gain>(view.p) * at(view, drive);
  }
  template <class V>
  static auto spool_force(const V& view) {
    return at(view, spool);
  }
  template <class V>
  static auto metering_opening(const V& view) {
    return at(view, metering);
  }
  template <class V>
  static auto flow_a(const V& view) {
    return at(view, at_a);
  }
  template <class V>
  static auto flow_b(const V& view) {
    return at(view, at_b);
  }
  template <class V>
  static auto piston_force(const V& view) {
    return at(view, piston);
  }
};

}  // namespace servodx
