// The gradient G of the right-hand side by all that one candidate may differ in from another: states, current,
// pressures at the ports, friction's memory, derived numbers and rows. One pass of the equations on dual numbers, each
// number with a type of its own, so that only entries that can differ from nought are there; their places are known at
// compile time. Left out: the load's force, which is the log's, and the rod's speed in friction's memory: no derivative
// is by them. Source: Griewank & Walther, Evaluating Derivatives, 2008, chapter 3. Equal to Ceres' Jet entry by entry
// (tests/laws/step_derivative_test.cpp).
#pragma once
#include <array>
#include <iterator>
#include <tuple>
#include <type_traits>
#include <utility>

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/system.h"

namespace servodx {

// Numbers of the variables: states first, then what else changes from step to step, then what a run has once.
template <class Effects>
struct Variables {
  static constexpr int n = n_base_states + Effects::n_states, n_seals = std::size(constants::seal_presliding);
  static constexpr int current = n, spool_anchor = current + 1, spool_speed = spool_anchor + 1,
                       seal_anchor = spool_speed + 1, seal_breakaway = seal_anchor + n_seals,
                       seal_per_reach = seal_breakaway + 1, moving = seal_per_reach + 1;
  static constexpr int supply_pressure = moving, return_pressure = supply_pressure + 1, derived = return_pressure + 1,
                       rows = derived + n_derived, size = rows + n_parameters + Effects::n_parameters;
  static_assert(size <= Mask::size, "more numbers than a set of variables holds: widen Mask (base/sparse_dual.h)");
};

// Numbers that carry derivatives, each a type of its own.
template <class T, int First>
struct SeededRows {
  const T* p;
};
template <int I, class T, int First>
Dual<T, only(First + I)> pick(const SeededRows<T, First>& rows) {
  return seed<First + I>(rows.p[I], T(1.0));
}
template <class T, int First>
struct SeededDerived {
  using Scalar = T;
#define X(name, unit, meaning) Dual<T, only(First + number_##name)> name;
  SERVODX_DERIVED(X)
#undef X
  explicit SeededDerived(const Derived<T>& d)
      :
#define X(name, unit, meaning) name(seed<First + number_##name>(d.name, T(1.0))),
        SERVODX_DERIVED(X)
#undef X
            end() {
  }
  Nothing end;
};
template <class T, class V>
struct SeededInputs {
  Dual<T, only(V::current)> current;
  Dual<T, only(V::supply_pressure)> supply_pressure;
  Dual<T, only(V::return_pressure)> return_pressure;
  T load_force;
  struct {
    Dual<T, only(V::spool_anchor)> spool_anchor;
    Dual<T, only(V::spool_speed)> spool_speed;
    std::array<Dual<T, range(V::seal_anchor, V::seal_anchor + V::n_seals)>, V::n_seals> seal_anchor;
    T rod_speed;
    Dual<T, only(V::seal_breakaway)> seal_breakaway;
    Dual<T, only(V::seal_per_reach)> seal_per_reach;
  } friction;
};

// G, entry by entry, at the points in the lanes of T.
template <class T, class Effects>
struct Gradient {
  using V = Variables<Effects>;
  static constexpr int n = V::n;

  template <class Take>
  static inline __attribute__((always_inline)) auto rates(const std::array<T, n>& y, const Inputs<T>& u, const T* p,
                                                          const Derived<T>& d, Take&& take) {
    const FrictionMemory<T>& f = u.friction;
    SeededInputs<T, V> in{seed<V::current>(u.current, T(1.0)),
                          seed<V::supply_pressure>(u.supply_pressure, T(1.0)),
                          seed<V::return_pressure>(u.return_pressure, T(1.0)),
                          u.load_force,
                          {seed<V::spool_anchor>(f.spool_anchor, T(1.0)),
                           seed<V::spool_speed>(f.spool_speed, T(1.0)),
                           {},
                           f.rod_speed,
                           seed<V::seal_breakaway>(f.seal_breakaway, T(1.0)),
                           seed<V::seal_per_reach>(f.seal_per_reach, T(1.0))}};
    unroll<V::n_seals>([&](auto i) {
      in.friction.seal_anchor[i].v = f.seal_anchor[i];
      unroll<V::n_seals>([&](auto j) { in.friction.seal_anchor[i].d[j] = T(i == j ? 1.0 : 0.0); });
    });
    return derivative<Effects, T>(DualStates<n, T>{y}, in, SeededRows<T, V::rows>{p}, SeededDerived<T, V::derived>(d),
                                  take);
  }
  struct Types {
    template <class... Rate>
    std::type_identity<std::tuple<Rate...>> operator()(const Rate&...) const {
      return {};
    }
  };
  using Rates = typename decltype(rates({}, {}, nullptr, std::declval<Derived<T>>(), Types{}))::type;
  static constexpr std::array<Mask, n> masks = []<int... I>(std::integer_sequence<int, I...>) {
    return std::array<Mask, n>{System<T, Effects, false>::template MaskOf<std::tuple_element_t<I, Rates>>::value...};
  }
  (std::make_integer_sequence<int, n>{});

  // Entries of a row stand together: those of states, of what moves besides, of the rest.
  struct Layout {
    std::array<int, n + 1> first{};
    std::array<int, n> states{}, moving{};  // number of entries
  };
  static constexpr Layout layout = [] {
    Layout l;
    for (int i = 0; i < n; ++i) {
      l.first[i + 1] = l.first[i] + count(masks[i]);
      l.states[i] = count(masks[i] & range(0, n));
      l.moving[i] = count(masks[i] & range(0, V::moving));
    }
    return l;
  }();
  static constexpr int entries = layout.first[n];
  static constexpr std::array<int, entries> variable_of = [] {
    std::array<int, entries> list{};
    for (int i = 0; i < n; ++i)
      for (int s = 0; s < count(masks[i]); ++s) list[layout.first[i] + s] = variable(masks[i], s);
    return list;
  }();

  static __attribute__((noinline, flatten)) void at(const std::array<T, n>& y, const Inputs<T>& u, const T* p,
                                                    const Derived<T>& d, std::array<T, entries>& out) {
    rates(
        y, u, p, d, [&](const auto&... rate) __attribute__((always_inline)) {
          int e = 0;
          const auto put = [&]<Mask M>(const Dual<T, M>& r) __attribute__((always_inline)) {
            unroll<count(M)>([&](auto s) { out[e++] = r.d[s]; });
          };
          (put(rate), ...);
        });
  }
};

}  // namespace servodx
