// The model as the stepper sees it: value, sparse Jacobian and derivative by time of one pack of candidates, from the
// equations of model/derivative.h on plain numbers and on dual ones. Inputs run in lines within a substep; the memory
// of friction stands still in it. No state is checked here: what leaves the finite numbers comes out as it may
// (simulate/shorter_steps.h looks at it).
// Source: equations docs/model.md; dual numbers Griewank & Walther, Evaluating Derivatives, 2008, chapter 3.
#pragma once
#include <array>
#include <tuple>
#include <utility>

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "integrate/sparse_lu.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/state.h"

namespace servodx {

template <int N, class T>
struct PlainStates {
  const std::array<T, N>& y;
  template <int K>
  T get() const {
    return y[K];
  }
};
template <int N, class T>
struct DualStates {
  const std::array<T, N>& y;
  template <int K>
  Dual<T, only(K)> get() const {
    return seed<K>(y[K], T(1.0));
  }
};

// The model as the stepper sees it. Settling: spool, piston and measured pressures are held, and the current is free
// and finds the value that holds the spool; its fixed point is the initial state.
template <class T, class Effects, bool Settling>
struct System {
  static constexpr int n = n_base_states + Effects::n_states;
  static constexpr Mask time_mask = only(n);
  using TimeDual = Dual<T, time_mask>;

  const T* p;
  const Derived<T>& d;
  Inputs<T> at, slope;                                    // at the start of the substep, and per second
  T hold_spool, hold_pressure, hold_piston, settle_rate;  // settling only: 1 held, 0 free

  template <class S, class In>
  inline __attribute__((always_inline)) auto evaluate(const S& s, const In& u) const {
    auto f = derivative<Effects, T>(s, u, p, d);
    if constexpr (!Settling) {
      return f;
    } else {
      // di/dt = -rate * (net spool force in terms of current) when the spool is held.
      const auto force = std::get<s_v_spool>(f) * (settle_rate * hold_spool);
      const T free_spool = T(1.0) - hold_spool, free_pressure = T(1.0) - hold_pressure,
              free_piston = T(1.0) - hold_piston;
      auto g = std::make_tuple(std::get<s_current>(f) * free_spool - force, std::get<1>(f), std::get<2>(f),
                               std::get<3>(f), std::get<4>(f), std::get<5>(f), std::get<s_x_spool>(f) * free_spool,
                               std::get<s_v_spool>(f) * free_spool, std::get<s_p_a>(f) * free_pressure,
                               std::get<s_p_b>(f) * free_pressure, std::get<s_x_piston>(f) * free_piston,
                               std::get<s_v_piston>(f) * free_piston);
      return std::tuple_cat(g, rest(f, std::make_integer_sequence<int, Effects::n_states>{}));
    }
  }
  template <class F, int... I>
  static auto rest(const F& f, std::integer_sequence<int, I...>) {
    return std::make_tuple(std::get<n_base_states + I>(f)...);
  }

  __attribute__((flatten)) void value(const std::array<T, n>& y, const T& t, std::array<T, n>& f) const {
    const Inputs<T> u{at.current + slope.current * t, at.supply_pressure + slope.supply_pressure * t,
                      at.return_pressure + slope.return_pressure * t, at.load_force + slope.load_force * t,
                      at.friction};
    const auto g = evaluate(PlainStates<n, T>{y}, u);
    unroll<n>([&](auto i) { f[i] = std::get<i>(g); });
  }

  using DualResult =
      decltype(std::declval<System>().evaluate(std::declval<DualStates<n, T>>(), std::declval<Inputs<TimeDual, T>>()));
  template <class X>
  struct MaskOf {
    static constexpr Mask value{};
  };
  template <class U, Mask M>
  struct MaskOf<Dual<U, M>> {
    static constexpr Mask value = M;
  };
  template <int I>
  static constexpr Mask mask_of() {
    return MaskOf<std::tuple_element_t<I, DualResult>>::value;
  }
  static constexpr Pattern<n> make_pattern() {
    Pattern<n> out;
    [&]<int... I>(std::integer_sequence<int, I...>) { ((out.row[I] = mask_of<I>() & ~time_mask), ...); }
    (std::make_integer_sequence<int, n>{});
    return out;
  }
  static constexpr Pattern<n> pattern = make_pattern();

  template <class W>
  __attribute__((flatten)) void value_and_jacobian(const std::array<T, n>& y, const T&, std::array<T, n>& f, W& w,
                                                   std::array<T, n>& f_t) const {
    using Lu = SparseLu<n, pattern>;
    const Inputs<TimeDual, T> u{seed<n>(at.current, slope.current), seed<n>(at.supply_pressure, slope.supply_pressure),
                                seed<n>(at.return_pressure, slope.return_pressure),
                                seed<n>(at.load_force, slope.load_force), at.friction};
    const auto g = evaluate(DualStates<n, T>{y}, u);
    unroll<n>([&](auto i) {
      constexpr Mask m = mask_of<i>();
      const auto& gi = std::get<i>(g);
      f[i] = gi.v;
      if constexpr (holds(m, n))
        f_t[i] = gi.d[slot(m, n)];
      else
        f_t[i] = T(0.0);
      unroll<n>([&](auto j) {
        if constexpr (Lu::plan.slot[i][j] >= 0) {
          if constexpr (holds(m, j))
            w[Lu::plan.slot[i][j]] = gi.d[slot(m, j)];
          else
            w[Lu::plan.slot[i][j]] = T(0.0);
        }
      });
    });
  }
};

}  // namespace servodx
