// The identification model: a two-stage flapper-nozzle servovalve with mechanical feedback and its actuator, the stages
// in order. One right-hand side for double, for a pack of candidates and for duals that carry derivatives.
//
// Source: Merritt (1967), chapters 3, 5, 6, 7; edges and smoothing are ours (docs/model.md). Leaves out: fluid inertia
// of lines, temperature within a log, transient flow force, spool rotation, drain pressure of the pilot stage.
// Signs: positive current -> flapper closes nozzle 1 -> p1 rises -> spool moves positive -> P to A -> piston extends.
#pragma once
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/smooth.h"
#include "base/sparse_dual.h"
#include "model/asperities.h"
#include "model/chamber.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"

namespace servodx {

// Fixed orifice, behind the laminar drop of its own length. [m3/s]
template <class P, class D>
auto fixed_orifice_flow(const P& dp, const D& d) {
  using T = typename D::Scalar;
  return d.orifice_conductance * signed_sqrt_behind(d.orifice_creep, dp, T(constants::orifice_transition));
}

// Nozzle: bore, land and curtain in series. opening [m] of the curtain; what roughness leaves open keeps a shut one's
// land finite. The bore's jet presses on the flapper with two velocity heads, one of which the bore has lost, so the
// force stays area times pressure drop (Merritt eq. 6-69 with the loss). [m3/s]
template <class X, class P, class D>
inline __attribute__((always_inline)) auto nozzle_flow(const X& opening, const P& dp, const D& d) {
  using T = typename D::Scalar;
  constexpr double rough2 = constants::stop_rounding * constants::stop_rounding;
  const auto square = opening * opening, clear = square + T(rough2);
  const auto z = inverse_root((d.bore_loss * square + T(1.0)) * (clear * clear));  // of the bore's loss, over `clear`
  return d.nozzle_conductance * opening * (clear * z) *
         signed_sqrt_behind(d.nozzle_creep * z, dp, T(constants::orifice_transition));
}
// With derivatives: taken in its own two variables, then carried to what those depend on.
template <class T, Mask A, Mask B, class D>
requires(A != only(0) || B != only(1)) inline
    __attribute__((always_inline)) auto nozzle_flow(const Dual<T, A>& opening, const Dual<T, B>& dp, const D& d) {
  return carried(nozzle_flow(seed<0>(opening.v, T(1.0)), seed<1>(dp.v, T(1.0)), d), opening, dp);
}

// Of a metering edge.
template <class Q, class J>
struct EdgeFlow {
  Q flow;  // [m3/s]
  J jet;   // [m3/s2] its flow times its speed over the port's width: what the force on the spool grows with
};

// The mean pressure of an edge lies half the drop from that of the line which its side shares.
template <class P, class V>
struct Thickening {
  P line;           // [Pa]
  V rise;           // [1/Pa] of the viscosity
  double per_drop;  // [-] of the mean pressure
};
template <class Effects, class D, class P>
inline __attribute__((always_inline)) auto thickening(const D& d, const P& line, double per_drop) {
  if constexpr (thickens_under_pressure(Effects{}))
    return Thickening{line, d.viscosity_rise, per_drop};
  else
    return Nothing{};
}
template <class T, class R, class DP>
inline __attribute__((always_inline)) R thickened(const R& resistance, Nothing, const DP&) {
  return resistance;
}
// Barus' exp(rise p), to its second order: at 400 bar and 2.5e-8 1/Pa short by 4 %.
template <class T, class R, class P, class V, class DP>
inline __attribute__((always_inline)) auto thickened(const R& resistance, const Thickening<P, V>& oil, const DP& dp) {
  const auto rise = oil.rise * (oil.line + T(oil.per_drop) * dp);
  return resistance * (T(1.0) + rise * (T(1.0) + T(0.5) * rise));
}

// (1 + a)^2 R^2, the square that the root holds, faded by 1 + c K|dp| / R^2. square [Pa2 s2/m2], turbulent: 4 K|dp|.
template <class T, class Q, class K>
inline __attribute__((always_inline)) Q faded(const Q& square, Nothing, const K&) {
  return square;
}
template <class T, class Q, class F, class K>
requires(!std::is_same_v<F, Nothing>) inline
    __attribute__((always_inline)) auto faded(const Q& square, const F& fading, const K& turbulent) {
  const auto part = fading * turbulent;
  return square * (T(1.0) - part * inverse(square + part));  // the square itself, to the bit, where nothing fades
}
template <class Effects, class D>
inline __attribute__((always_inline)) auto fading(const D& d) {
  if constexpr (laminar_drop_fades(Effects{}))
    return d.creep_fading;
  else
    return Nothing{};
}

// Edges that share a line.
template <class R, class L, class O = Nothing, class F = Nothing>
struct EdgeSide {
  R radius;    // [m] of the corners
  L line;      // [Pa s2/m4] of the hose and what else the flow passes, per opening squared
  O oil{};     // how it thickens in the edge
  F fading{};  // [-] c (1 + a)^2 / 4
};
template <class Effects, class D, class P>
inline __attribute__((always_inline)) auto from_supply(const D& d, const P& supply_pressure) {
  return EdgeSide{d.supply_edge, d.hose_loss, thickening<Effects>(d, supply_pressure, -0.5), fading<Effects>(d)};
}
template <class Effects, class D, class P>
inline __attribute__((always_inline)) auto to_return(const D& d, const P& return_pressure) {
  return EdgeSide{d.return_edge, d.return_loss, thickening<Effects>(d, return_pressure, 0.5), fading<Effects>(d)};
}

// One metering edge. opening [m] (negative: covered by that length), dp [Pa].
// Laminar slot, orifice and line in series: dp = R q + K q|q|, so q = 2 dp / (R + sqrt(R^2 + 4 K |dp|)).
// R: plane slot of the covered length and creeping flow at the edge; K: Bernoulli at the edge plus the line.
// An abrupt transition a in place of the sum: q = 2 dp / ((1 - a) R + sqrt((1 + a)^2 R^2 + 4 K |dp|)); r holds 1 + a.
template <class X, class R, class L, class O, class F, class P, class D>
inline __attribute__((always_inline)) auto metering_edge(const X& opening, const EdgeSide<R, L, O, F>& side,
                                                         const P& dp, const D& d) {
  using T = typename D::Scalar;
  // Twice what is open and what is covered: their halves would be products that the constants can hold.
  const auto length = smooth_abs(opening, side.radius);
  const auto open = opening + length, covered = length - opening;
  const auto h2 = open * open + d.clearance2;
  const auto [h, per_h] = both_roots(h2);
  const auto slot = thickened<T>(d.slot_per_length * covered + d.slot_corner, side.oil, dp);
  const auto r = slot * per_h;  // [Pa s/m] times width and h
  const auto k = d.edge_loss + side.line * h2;
  const auto size = magnitude(dp);
  const auto turbulent = k * size, laminar = faded<T>(r * r, side.fading, turbulent);
  const auto per = inverse(d.creep_added * r + root(laminar + turbulent));  // [m/s/Pa] half the mean speed over dp
  const auto through = h * (dp * per);                                      // [m2/s] the flow over the port's width
  return EdgeFlow{d.width * through, through * (size * per)};
}

template <class T, Mask A, Mask B, class R, class L, class O, class F, class D>
requires(A != only(0) || B != only(1)) inline
    __attribute__((always_inline)) auto metering_edge(const Dual<T, A>& opening, const EdgeSide<R, L, O, F>& side,
                                                      const Dual<T, B>& dp, const D& d) {
  const auto [q, jet] = metering_edge(seed<0>(opening.v, T(1.0)), side, seed<1>(dp.v, T(1.0)), d);
  return EdgeFlow{carried(q, opening, dp), carried(jet, opening, dp)};
}
// The line's pressure is a third variable where it depends on any itself.
template <class T, Mask A, Mask B, Mask C, class R, class L, class V, class F, class D>
requires(A != only(0) || B != only(1) || C != only(2)) inline
    __attribute__((always_inline)) auto metering_edge(const Dual<T, A>& opening,
                                                      const EdgeSide<R, L, Thickening<Dual<T, C>, V>, F>& side,
                                                      const Dual<T, B>& dp, const D& d) {
  const auto& oil = side.oil;
  const EdgeSide seeded{side.radius, side.line, Thickening{seed<2>(oil.line.v, T(1.0)), oil.rise, oil.per_drop},
                        side.fading};
  const auto [q, jet] = metering_edge(seed<0>(opening.v, T(1.0)), seeded, seed<1>(dp.v, T(1.0)), d);
  return EdgeFlow{carried(q, opening, dp, oil.line), carried(jet, opening, dp, oil.line)};
}

// Pilot flow through the filter, whose blocked part may differ with the direction of the spool, behind the laminar drop
// of its pores: as many pass the flow as are open, so that drop stays in proportion to the root of the other. [m3/s]
template <class P, class V, class D>
auto filter_flow(const P& dp, const V& v_spool, const D& d) {
  using T = typename D::Scalar;
  namespace c = constants;
  const auto direction = smooth_sign(v_spool, T(c::filter_direction_rounding));
  return (d.filter_conductance - d.filter_one_way * direction) *
         signed_sqrt_behind(d.filter_creep, dp, T(c::orifice_transition));
}

// Share of a stop's damping that acts, 0 clear of it to 1 well inside: oil is squeezed out before there is contact. [m]
template <class X, class T>
auto in_contact(const X& over, const X& under, const T& rounding) {
  const auto depth = over + under;
  return depth * inverse(depth + rounding);
}

// Inputs with the supply pressure as it is at the valve.
template <class In, class P>
struct AtValve {
  decltype(In::current) current;
  P supply_pressure;
  decltype(In::return_pressure) return_pressure;
  decltype(In::load_force) load_force;
};

// Gives the derivatives of all states, base states first, then the effects', to `take` and returns what it returns.
// S: s.get<K>() gives state K. In, Rows, D: like Inputs, a candidate and Derived, their numbers duals or plain.
template <class Effects, class T, class S, class In, class Rows, class D, class Take>
inline __attribute__((always_inline)) auto derivative(const S& s, const In& in, const Rows& p, const D& d,
                                                      Take&& take) {
  namespace c = constants;
  const View<Effects, T, S, In, Rows, D> view{s, in, p, d};
  const auto supply = in.supply_pressure + hook_supply_pressure(view, Effects{});
  const AtValve<In, std::decay_t<decltype(supply)>> u{in.current, supply, in.return_pressure, in.load_force};
  const auto z_f = s.template get<s_x_flapper>();
  const auto v_f = s.template get<s_v_flapper>();
  const auto p_f = s.template get<s_p_filter>();
  const auto p_1 = s.template get<s_p_pilot_1>();
  const auto p_2 = s.template get<s_p_pilot_2>();
  const auto x_s = s.template get<s_x_spool>();
  const auto v_s = s.template get<s_v_spool>();
  const auto p_a = s.template get<s_p_a>();
  const auto p_b = s.template get<s_p_b>();
  const auto x_p = s.template get<s_x_piston>();
  const auto v_p = s.template get<s_v_piston>();

  // Driver and coil.
  const auto i = s.template get<s_current>();
  const auto di = d.driver_rate * (u.current - i);

  // Torque motor and flapper. The wire pulls through its backlash. The nozzles are the stops: s_x_flapper is where the
  // force would take a free flapper, and the flapper follows it up to the nozzle. That leaves out the impact (a few
  // tenths of a millisecond) and keeps a wall out of the equations, which no linearly implicit step sees coming.
  const auto x_f = flapper_travel(z_f, p);
  const auto wire = pick<row::feedback_wire_stiffness>(p) * dead_zone(x_s + x_f, d.half_backlash, c::backlash_rounding);
  const auto f_flapper = pick<row::torque_motor_gain>(p) * i - pick<row::flapper_stiffness>(p) * z_f - wire -
                         d.nozzle_area * (p_1 - p_2) + hook_flapper_force(view, Effects{});
  const auto dv_f = d.flapper_rate2 * f_flapper - d.flapper_damping * v_f;

  // Filter, fixed orifices, nozzles, spool ends.
  const auto q_filter = filter_flow(u.supply_pressure - p_f, v_s, d);
  const auto q_orifice_1 = fixed_orifice_flow(p_f - p_1, d);
  const auto q_orifice_2 = fixed_orifice_flow(p_f - p_2, d);
  const auto q_nozzle_1 = nozzle_flow(d.nozzle_1_share * (pick<row::nozzle_gap>(p) - x_f), p_1 - u.return_pressure, d);
  const auto q_nozzle_2 = nozzle_flow(d.nozzle_2_share * (pick<row::nozzle_gap>(p) + x_f), p_2 - u.return_pressure, d);
  const auto dp_f = d.inverse_filter_compliance * (q_filter - q_orifice_1 - q_orifice_2);
  const auto dp_1 = d.inverse_pilot_compliance * (q_orifice_1 - q_nozzle_1 - d.spool_area * v_s);
  const auto dp_2 = d.inverse_pilot_compliance * (q_orifice_2 - q_nozzle_2 + d.spool_area * v_s);

  // Metering edges. Flows carry direction: pa from supply to A, at from A to return.
  const auto x_m = x_s + hook_metering_opening(view, Effects{});
  const auto from = from_supply<Effects>(d, in.supply_pressure);  // a sag of the supply hardly thins the oil
  const auto to = to_return<Effects>(d, u.return_pressure);
  const auto [q_pa, jet_pa] = metering_edge(x_m - pick<row::lap_pa>(p), from, u.supply_pressure - p_a, d);
  const auto [q_pb, jet_pb] = metering_edge(-x_m - pick<row::lap_pb>(p), from, u.supply_pressure - p_b, d);
  const auto [q_at, jet_at] = metering_edge(-x_m - pick<row::lap_at>(p), to, p_a - u.return_pressure, d);
  const auto [q_bt, jet_bt] = metering_edge(x_m - pick<row::lap_bt>(p), to, p_b - u.return_pressure, d);

  // Spool.
  // Steady, by the momentum of the jets: laminar ones have less than their pressure drop would give a turbulent one.
  const auto f_flow = d.flow_force * (jet_pa + jet_bt - jet_pb - jet_at);
  const auto f_dry =
      pick<row::spool_friction>(p) * asperities<T>((x_s - in.friction.spool_anchor) * d.per_spool_presliding);
  const auto beyond = x_s - pick<row::spool_stop>(p), behind = -x_s - pick<row::spool_stop>(p);
  const auto in_spool_stop =
      in_contact(contact_depth(beyond, c::spool_film), contact_depth(behind, c::spool_film), T(c::spool_film));
  const auto f_spool = d.spool_area * (p_1 - p_2) - f_flow - f_dry - d.spool_viscous * v_s -
                       T(c::spool_stop_stiffness) * (contact_depth(beyond, c::spool_stop_rounding) -
                                                     contact_depth(behind, c::spool_stop_rounding)) -
                       T(c::spool_stop_damping) * (in_spool_stop * v_s) + hook_spool_force(view, Effects{});
  const auto dv_s = d.inverse_spool_mass * f_spool;

  // Chambers. The body may move; volumes and the sensor see the rod relative to it.
  const auto v_rel = v_p - hook_body_velocity(view, Effects{});
  const auto q_leak = d.leak * (p_a - p_b);
  const auto volume_a = d.middle_volume_a + pick<row::piston_area_a>(p) * x_p + hook_volume_a(view, Effects{});
  const auto volume_b = d.middle_volume_b - pick<row::piston_area_b>(p) * x_p + hook_volume_b(view, Effects{});
  const auto walls = pick<row::hose_compliance>(p) + hook_wall_compliance(view, Effects{});
  const auto dp_a = (q_pa - q_at - q_leak - pick<row::piston_area_a>(p) * v_rel + hook_flow_a(view, Effects{})) *
                    chamber_stiffness<Effects>(volume_a, walls, p_a, d);
  const auto dp_b = (q_pb - q_bt + q_leak + pick<row::piston_area_b>(p) * v_rel + hook_flow_b(view, Effects{})) *
                    chamber_stiffness<Effects>(volume_b, walls, p_b, d);

  // Piston.
  constexpr int n_families = std::size(c::seal_presliding);
  const auto seals = [&]<int... I>(std::integer_sequence<int, I...>) {
    return (asperities<T>((x_p - in.friction.seal_anchor[I]) *
                          (T(1.0 / c::seal_presliding[I]) * in.friction.seal_per_reach)) +
            ...) *
           T(1.0 / n_families);
  }
  (std::make_integer_sequence<int, n_families>{});
  const auto f_friction =
      d.viscous * v_rel + seals * (pick<row::piston_coulomb_friction>(p) +
                                   pick<row::piston_stribeck_friction>(p) * in.friction.seal_breakaway);
  const auto over = contact_depth(x_p - d.half_stroke, c::piston_stop_rounding);
  const auto under = contact_depth(-x_p - d.half_stroke, c::piston_stop_rounding);
  const auto in_stop = in_contact(over, under, T(c::piston_stop_rounding));
  const auto f_piston = pick<row::piston_area_a>(p) * p_a - pick<row::piston_area_b>(p) * p_b - u.load_force -
                        f_friction - T(c::piston_stop_stiffness) * (over - under) -
                        T(c::piston_stop_damping) * (in_stop * v_rel) + hook_piston_force(view, Effects{}) +
                        hook_pressure_force(view, Effects{});
  const auto dv_p = d.inverse_mass * f_piston;

  return effect_derivatives(
      view, Effects{}, [&](const auto&... own) __attribute__((always_inline)) {
        return take(di, v_f, dv_f, dp_f, dp_1, dp_2, v_s, dv_s, dp_a, dp_b, v_rel, dv_p, own...);
      });
}
// The same as a tuple.
template <class Effects, class T, class S, class In, class Rows, class D>
inline __attribute__((always_inline)) auto derivative(const S& s, const In& in, const Rows& p, const D& d) {
  return derivative<Effects, T>(s, in, p, d, [](const auto&... rates) { return std::make_tuple(rates...); });
}

}  // namespace servodx
