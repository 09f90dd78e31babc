// Named places of the model that effects fill. The model knows no effect; an effect is a struct with
//   name, place, parameters (static list), n_states, and any of these members, each taking a view of the run:
//     struct Memory, drive(memory, time, command, spring, p)  [A]  applied to the command at each sample, with
//     memory of its past; struct Sensors, observe(sensors, time, shown, p)  [SI]  applied to what is reported at each
//     sample
//     viscosity(p, oil)    [-]   factor on the oil's viscosity
//     viscosity_rise(p)    [1/Pa] relative rise of the oil's viscosity with pressure, in the metering edges
//     stiffness_rise(p)    [-]   rise of the oil's bulk modulus per pressure
//     edge_rounding(p, to_return) [m] added to the corner radius of the metering edges
//     edge_creep(p)        [-]   added to the creeping-flow length of an open edge, in openings
//     edge_abruptness(p)   [-]   how fast the flow through an open edge is turbulent, 0 to 2
//     edge_fading(p)       [-]   how fast its laminar drop then fades beside the turbulent one
//     return_share(p)      [-]   drop of the return line over that of an edge at full stroke
//     orifice_length(p)    [-]   added to the length of the fixed orifices, in diameters
//     nozzle_1_share(p), nozzle_2_share(p)  [-]  added to the share of a nozzle's gap that is open
//     nozzle_land(p)       [m]   added to the width of the nozzles' faces
//     screen_drop(p)       [Pa]  laminar drop of the clean pilot filter at rest, in oil at 40 degC
//     seal_film_speed(p)   [m/s] added to the speed at which the piston's seals slide on oil
//     seal_shear(p)        [-]   share of the piston's viscous friction in proportion to the viscosity
//     seal_dry(p)          [-]   share of it that the viscosity leaves alone
//     spool_yield(p)       [m]   added to the way over which the spool's dry friction is taken up
//     supply_pressure(view) [Pa] added to the supply pressure at the valve
//     flapper_force(view)  [N]   added to the torque motor's force
//     spool_force(view)    [N]   added to the force on the spool
//     metering_opening(view) [m] added to the spool's travel where the edges meter
//     flow_a(view), flow_b(view) [m3/s]  added to the flow into the chamber
//     volume_a(view), volume_b(view) [m3] added to the oil that the edges fill; wall_compliance(view) [m3/Pa] to its
//     walls'
//     piston_force(view)   [N]   added to the force on the piston
//     pressure_force(view) [N]   added to the force of the chambers' pressures, on the piston and on the body
//     body_velocity(view)  [m/s] of the cylinder body; the rod is measured relative to it
//     derivative(view)     tuple of the derivatives of its own states
//     at_rest(own, y, q, p)  sets its own states to where they rest beside the base states y, q: its own parameters, p:
//     the rows; without it they rest at 0
//     measured(shown, y, own, q)  puts what sensors are exposed to in place of the base model's among what is shown,
//     before any sensor's lag and gain; own: its own states
// A place without an effect adds nothing, not even a zero.
#pragma once
#include <tuple>
#include <type_traits>

#include "base/smooth.h"
#include "model/constants.h"
#include "model/state.h"
#include "parameters/list.h"

namespace servodx {

struct Nothing {};
template <class X>
X operator+(const X& x, Nothing) {
  return x;
}
template <class X>
requires(!std::is_same_v<X, Nothing>) X operator+(Nothing, const X& x) { return x; }
template <class X>
X operator-(const X& x, Nothing) {
  return x;
}

template <class... E>
struct EffectList {
  static constexpr int size = sizeof...(E);
  static constexpr int n_states = (0 + ... + E::n_states);
  static constexpr int n_parameters = (0 + ... + E::n_parameters);
  // Offset of an effect's own states or parameters among all effects'.
  template <class Wanted>
  static constexpr int state_offset() {
    int at = 0;
    bool found = false;
    ((found = found || std::is_same_v<E, Wanted>, at += found ? 0 : E::n_states), ...);
    return at;
  }
  template <class Wanted>
  static constexpr int parameter_offset() {
    int at = 0;
    bool found = false;
    ((found = found || std::is_same_v<E, Wanted>, at += found ? 0 : E::n_parameters), ...);
    return at;
  }
};

// A row of a candidate, p[I], SI. By number of the compiler's, as rows that carry derivatives have a type each
// (simulate/gradient.h).
template <int I, class T>
const T& pick(const T* p) {
  return p[I];
}

// Travel of the flapper [m]: `free` [m] is where the force would take it if no nozzle stopped it.
template <class X, class Rows>
auto flapper_travel(const X& free, const Rows& p) {
  return saturate(free, pick<row::nozzle_gap>(p), constants::stop_rounding);
}

// In the place of an effect that a list leaves out: its numbers stay where a candidate has them, and nothing of it
// runs.
template <class E>
struct Absent {
  static constexpr int n_states = 0;
  static constexpr int n_parameters = E::n_parameters;
};
template <class List, class... Left>
struct LeaveOut;
template <class... E, class... Left>
struct LeaveOut<EffectList<E...>, Left...> {
  template <class One>
  using Kept = std::conditional_t<(std::is_same_v<One, Left> || ...), Absent<One>, One>;
  using type = EffectList<Kept<E>...>;
};
template <class List, class... Left>
using Without = typename LeaveOut<List, Left...>::type;

template <class List, class Last>
struct AppendTo;
template <class... E, class Last>
struct AppendTo<EffectList<E...>, Last> {
  using type = EffectList<E..., Last>;
};
template <class List, class Last>
using Append = typename AppendTo<List, Last>::type;

// What a hook sees: states, inputs and rows.
template <class List, class T, class States, class In, class Rows, class Numbers>
struct View {
  using Effects = List;
  using Scalar = T;  // double or a pack
  const States& s;
  const In& u;
  const Rows& p;     // the 41 rows, then the effects' parameters in the order of the list
  const Numbers& d;  // what follows from them (model/derived.h)

  template <int K>
  auto state() const {
    return s.template get<K>();
  }
  // J-th parameter of effect E, SI.
  template <class E, int J>
  auto own() const {
    return pick<n_parameters + List::template parameter_offset<E>() + J>(p);
  }
  // J-th state of effect E.
  template <class E, int J>
  auto own_state() const {
    return s.template get<n_base_states + List::template state_offset<E>() + J>();
  }
};

#define SERVODX_HOOK(name)                                                                  \
  template <class V, class... E>                                                            \
  inline __attribute__((always_inline)) auto hook_##name(const V& view, EffectList<E...>) { \
    return (Nothing{} + ... + [&](auto effect) __attribute__((always_inline)) {             \
      if constexpr (requires { effect.name(view); })                                        \
        return effect.name(view);                                                           \
      else                                                                                  \
        return Nothing{};                                                                   \
    }(E{}));                                                                                \
  }
SERVODX_HOOK(supply_pressure)
SERVODX_HOOK(flapper_force)
SERVODX_HOOK(spool_force)
SERVODX_HOOK(metering_opening)
SERVODX_HOOK(flow_a)
SERVODX_HOOK(flow_b)
SERVODX_HOOK(volume_a)
SERVODX_HOOK(volume_b)
SERVODX_HOOK(wall_compliance)
SERVODX_HOOK(piston_force)
SERVODX_HOOK(pressure_force)
SERVODX_HOOK(body_velocity)
#undef SERVODX_HOOK

// Factor on the oil's viscosity, 1 without an effect; p: a candidate.
template <class T, class... E>
T hook_viscosity([[maybe_unused]] const T* p, [[maybe_unused]] const Oil& oil, EffectList<E...>) {
  T factor = T(1.0);
  (
      [&] {
        if constexpr (requires { E::viscosity(p, oil); })
          factor = factor * E::viscosity(p + n_parameters + EffectList<E...>::template parameter_offset<E>(), oil);
      }(),
      ...);
  return factor;
}

// What the effects add to a number that is fixed for the whole run.
#define SERVODX_FIXED_HOOK(place)                                                                          \
  template <class T, class... E>                                                                           \
  T hook_##place([[maybe_unused]] const T* p, EffectList<E...>) {                                          \
    T added = T(0.0);                                                                                      \
    (                                                                                                      \
        [&] {                                                                                              \
          if constexpr (requires { E::place(p); })                                                         \
            added = added + E::place(p + n_parameters + EffectList<E...>::template parameter_offset<E>()); \
        }(),                                                                                               \
        ...);                                                                                              \
    return added;                                                                                          \
  }
SERVODX_FIXED_HOOK(viscosity_rise)
SERVODX_FIXED_HOOK(stiffness_rise)
SERVODX_FIXED_HOOK(edge_creep)
SERVODX_FIXED_HOOK(edge_abruptness)
SERVODX_FIXED_HOOK(edge_fading)
SERVODX_FIXED_HOOK(return_share)
SERVODX_FIXED_HOOK(orifice_length)
SERVODX_FIXED_HOOK(nozzle_1_share)
SERVODX_FIXED_HOOK(nozzle_2_share)
SERVODX_FIXED_HOOK(nozzle_land)
SERVODX_FIXED_HOOK(screen_drop)
SERVODX_FIXED_HOOK(seal_film_speed)
SERVODX_FIXED_HOOK(seal_shear)
SERVODX_FIXED_HOOK(seal_dry)
SERVODX_FIXED_HOOK(spool_yield)
#undef SERVODX_FIXED_HOOK

// Whether any effect lets the viscosity rise with pressure: where none does, nothing asks for the pressure.
template <class... E>
consteval bool thickens_under_pressure(EffectList<E...>) {
  return (requires(const double* q) { E::viscosity_rise(q); } || ...);
}
// Whether any effect lets the laminar drop of an edge fade: where none does, its steps are saved.
template <class... E>
consteval bool laminar_drop_fades(EffectList<E...>) {
  return (requires(const double* q) { E::edge_fading(q); } || ...);
}

// The same of its stiffness.
template <class... E>
consteval bool stiffens_under_pressure(EffectList<E...>) {
  return (requires(const double* q) { E::stiffness_rise(q); } || ...);
}

// What the effects add to the corner radius of the metering edges, those to return or those from supply. [m]
template <class T, class... E>
T hook_edge_rounding([[maybe_unused]] const T* p, [[maybe_unused]] bool to_return, EffectList<E...>) {
  T added = T(0.0);
  (
      [&] {
        if constexpr (requires { E::edge_rounding(p, to_return); })
          added =
              added + E::edge_rounding(p + n_parameters + EffectList<E...>::template parameter_offset<E>(), to_return);
      }(),
      ...);
  return added;
}

// y: all states, the effects' behind the base states.
template <class T, class... E>
void effects_at_rest([[maybe_unused]] T* y, [[maybe_unused]] const T* p, EffectList<E...>) {
  (
      [&] {
        if constexpr (requires { E::at_rest(y, y, p, p); })
          E::at_rest(y + n_base_states + EffectList<E...>::template state_offset<E>(), y,
                     p + n_parameters + EffectList<E...>::template parameter_offset<E>(), p);
      }(),
      ...);
}

// shown: as model/shown.h has them; y: all states.
template <class T, class... E>
void effects_measured([[maybe_unused]] T* shown, [[maybe_unused]] const T* y, [[maybe_unused]] const T* p,
                      EffectList<E...>) {
  (
      [&] {
        if constexpr (requires { E::measured(shown, y, y, p); })
          E::measured(shown, y, y + n_base_states + EffectList<E...>::template state_offset<E>(),
                      p + n_parameters + EffectList<E...>::template parameter_offset<E>());
      }(),
      ...);
}

// Gives the derivatives of the effects' states, in the order of the list, to `take` and returns what it returns.
template <class V, class Take>
inline __attribute__((always_inline)) auto effect_derivatives(const V&, EffectList<>, Take&& take) {
  return take();
}
template <class V, class E, class... Others, class Take>
inline __attribute__((always_inline)) auto effect_derivatives(const V& view, EffectList<E, Others...>, Take&& take) {
  if constexpr (requires { E::derivative(view); }) {
    const auto own = E::derivative(view);
    static_assert(std::tuple_size_v<std::remove_const_t<decltype(own)>> == E::n_states);
    return effect_derivatives(
        view, EffectList<Others...>{}, [&](const auto&... rest) __attribute__((always_inline)) {
          return [&]<int... I>(std::integer_sequence<int, I...>) __attribute__((always_inline)) {
            return take(std::get<I>(own)..., rest...);
          }
          (std::make_integer_sequence<int, E::n_states>{});
        });
  } else {
    return effect_derivatives(view, EffectList<Others...>{}, take);
  }
}

}  // namespace servodx
