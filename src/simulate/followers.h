// The derivative of a run's steps: candidates that lie near another one follow its run, a few products a step in place
// of a step of their own.
//
// W k = f has the same W for all of them, so W dk = df - dW k has the factors that the run has already. With the sign
// of rodas3_step, and G the gradient of the right-hand side by all that a candidate may differ in (v: states, current,
// friction's memory, derived numbers, rows):
//
//   W dk1 = G(y) dv - dW k1         W dk2 = G(y) dv - dW k2 - 4/h dk1
//   W dk3 = G(z) dz - dW k3 + (dk2 - dk1)/h
//   W dk4 = G(z') dz' - dW k4 + (dk2 - dk1)/h + 8/(3h) dk3,     z = y - 2 k1, z' = z - k3
//
// dW k is the difference of G at y and at y - epsilon k, over -epsilon: G is wanted at seven points, which stand in the
// lanes of packs. What is around the steps (the settling, inputs and their memories, friction's memory, sensors) is
// each candidate's own run. So a follower differs from a run of its own by the second order of how far it is off, and
// by the rounding of floats, which carry differences alone.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "integrate/sparse_lu.h"
#include "model/asperities.h"
#include "model/derived.h"
#include "model/state.h"
#include "simulate/gradient.h"
#include "simulate/pack_run.h"
#include "simulate/scenario.h"
#include "simulate/step_recorder.h"

namespace servodx {

// As many candidates as F, a pack of floats, has lanes, on their way beside the run that they follow. T: a pack of half
// as many doubles.
template <class T, class F, class Effects>
class Followers {
 public:
  using Base = Run<T, Effects>;
  using V = Variables<Effects>;
  using Step = TakenStep<Effects>;
  using G = Gradient<double, Effects>;
  static constexpr int n = V::n, half = Lanes<T>::count;
  static_assert(F::lanes == 2 * half);

  Followers(const Base& base, const Scenario& in, const ParameterVector* const* candidates, Trajectory* const* results,
            int lanes, const SimulateOptions& options)
      : low_(in, candidates, results, std::min(lanes, half), options),
        high_(in, candidates + (lanes > half ? half : 0), results + (lanes > half ? half : 0),
              lanes > half ? lanes - half : 0, options) {
    const auto differ = [&](auto&& number) {
      return joined(number(low_) - number(base), number(high_) - number(base));
    };
    for (int i = 0; i < n; ++i) off_[i] = differ([&](const Base& r) { return r.y[i]; });
    std::vector<F> all(V::size, F(0.0));
    all[V::supply_pressure] = differ([](const Base& r) { return r.inputs().supply_pressure; });
    all[V::return_pressure] = differ([](const Base& r) { return r.inputs().return_pressure; });
#define X(name, unit, meaning) all[V::derived + number_##name] = differ([](const Base& r) { return r.derived().name; });
    SERVODX_DERIVED(X)
#undef X
    for (int k = 0; V::rows + k < V::size; ++k) all[V::rows + k] = differ([&](const Base& r) { return r.p()[k]; });
    std::vector<int> place(V::size, -1);
    for (int v = V::moving; v < V::size; ++v)
      for (int lane = 0; lane < F::lanes && place[v] < 0; ++lane)
        if (all[v][lane] != 0.0) place[v] = static_cast<int>(differences_.size()), differences_.push_back(all[v]);
    for (int i = 0; i < n; ++i) {
      terms_of_[i] = static_cast<int>(terms_.size());
      for (int e = G::layout.first[i] + G::layout.moving[i]; e < G::layout.first[i + 1]; ++e)
        if (const int at = place[G::variable_of[e]]; at >= 0)
          terms_.push_back({static_cast<std::size_t>(e), static_cast<std::size_t>(at)});
    }
    terms_of_[n] = static_cast<int>(terms_.size());
  }

  bool sticks() const { return low_.sticks || high_.sticks; }
  void stick() { low_.sticks = high_.sticks = true; }
  void ask_for(std::array<bool, G::entries>& wanted) const {
    for (const Term& t : terms_) wanted[t.entry] = true;
  }

  // Along the steps of the followed run to its next sample.
  void next(std::span<const Step> steps) {
    low_.begin(), high_.begin();
    for (const Step& s : steps) take(s);
    for (int i = 0; i < n; ++i) move(i, steps.back());
    low_.end(), high_.end();
  }

 private:
  // A state of the candidates, after a step.
  void move(int i, const Step& s) {
    const auto [low, high] = split(off_[i]);
    low_.y[i] = T(s.to[i]) + low, high_.y[i] = T(s.to[i]) + high;
  }
  __attribute__((noinline, flatten)) void take(const Step& s) {
    std::array<F, V::moving> dv;
    for (int i = 0; i < n; ++i) dv[i] = off_[i];
    const auto friction = [&](auto&& number) {
      const T was = T(number(s.at.friction));
      return joined(number(low_.friction) - was, number(high_.friction) - was);
    };
    dv[V::spool_anchor] = friction([](const auto& f) { return f.spool_anchor; });
    dv[V::spool_speed] = friction([](const auto& f) { return f.spool_speed; });
    for (int i = 0; i < V::n_seals; ++i)
      dv[V::seal_anchor + i] = friction([&](const auto& f) { return f.seal_anchor[i]; });
    dv[V::seal_breakaway] = friction([](const auto& f) { return f.seal_breakaway; });
    dv[V::seal_per_reach] = friction([](const auto& f) { return f.seal_per_reach; });
    // The current drives linearly, and its own state alone: its slope acts as a current later in the step.
    static_assert([] {
      for (int i = 0; i < n; ++i)
        if (i != s_current && holds(G::masks[i], V::current)) return false;
      return true;
    }());
    const T at = T(s.at.current);
    low_.take_command(s.after, s.h), high_.take_command(s.after, s.h);
    const F current = joined(low_.current(s.after) - at, high_.current(s.after) - at);
    const F slope =
        joined(low_.live.slope.current - T(s.slope.current), high_.live.slope.current - T(s.slope.current)) * F(s.h);
    const F current_at[4] = {current + F(0.5) * slope, current + F(1.5) * slope, current + slope, current + slope};

    std::array<F, n> r1, r2, r3, r4;
    unroll<n>([&](auto i) {
      F a[4] = {F(0.0), F(0.0), F(0.0), F(0.0)};
      unroll<G::layout.moving[i]>([&](auto k) {
        constexpr int e = G::layout.first[i] + k, v = G::variable_of[e];
        for (int stage = 0; stage < 4; ++stage)
          a[stage] = multiply_add(F(s.g[e][stage]), v == V::current ? current_at[stage] : dv[v], a[stage]);
      });
      for (int t = terms_of_[i]; t < terms_of_[i + 1]; ++t) {
        const float* g = s.g[terms_[t].entry];
        const F x = differences_[terms_[t].at];
        for (int stage = 0; stage < 4; ++stage) a[stage] = multiply_add(F(g[stage]), x, a[stage]);
      }
      r1[i] = a[0], r2[i] = a[1], r3[i] = a[2], r4[i] = a[3];
    });
    using Lu = typename Step::Lu;
    const F inv_h = F(1.0 / s.h), four = F(4.0 / s.h), eight = F(8.0 / (3.0 * s.h));
    // What z and z' lie off y by: the stages' differences.
    std::array<F, n> off;
    const auto less_states = [&](std::array<F, n>& r, int where) {
      unroll<n>([&](auto i) {
        unroll<G::layout.states[i]>([&](auto k) {
          constexpr int e = G::layout.first[i] + k;
          r[i] = subtract_product(r[i], F(s.g[e][where]), off[G::variable_of[e]]);
        });
      });
    };
    Lu::template solve<F>(s.lu, r1);
    unroll<n>([&](auto i) { r2[i] = subtract_product(r2[i], four, r1[i]); });
    Lu::template solve<F>(s.lu, r2);
    unroll<n>([&](auto i) { off[i] = r1[i] + r1[i]; });
    less_states(r3, Step::at_z);
    unroll<n>([&](auto i) { r2[i] = (r2[i] - r1[i]) * inv_h, r3[i] = r3[i] + r2[i]; });
    Lu::template solve<F>(s.lu, r3);
    unroll<n>([&](auto i) { off[i] = off[i] + r3[i]; });
    less_states(r4, Step::at_z2);
    unroll<n>([&](auto i) { r4[i] = multiply_add(eight, r3[i], r4[i] + r2[i]); });
    Lu::template solve<F>(s.lu, r4);

    for (int i = 0; i < n; ++i) off_[i] = dv[i] - off[i] - r4[i];
    const T spool_low = low_.y[s_x_spool], rod_low = low_.y[s_x_piston], spool_high = high_.y[s_x_spool],
            rod_high = high_.y[s_x_piston];
    move(s_x_spool, s), move(s_x_piston, s);
    low_.remember(spool_low, rod_low, s.h), high_.remember(spool_high, rod_high, s.h);
  }

  struct Term {
    std::size_t entry, at;
  };
  using HalfOfFloats = typename Pack<half, 0, float>::Vector;

  static F joined(const T& low, const T& high) {
    const auto a = __builtin_convertvector(low.v, HalfOfFloats), b = __builtin_convertvector(high.v, HalfOfFloats);
    return [&]<int... I>(std::integer_sequence<int, I...>) { return F(__builtin_shufflevector(a, b, I...)); }
    (std::make_integer_sequence<int, F::lanes>{});
  }
  static std::pair<T, T> split(const F& x) {
    return [&]<int... I>(std::integer_sequence<int, I...>) {
      return std::pair(
          T(__builtin_convertvector(__builtin_shufflevector(x.v, x.v, I...), typename T::Vector)),
          T(__builtin_convertvector(__builtin_shufflevector(x.v, x.v, (half + I)...), typename T::Vector)));
    }
    (std::make_integer_sequence<int, half>{});
  }

  Base low_, high_;
  std::array<F, n> off_;  // the states less those of the followed run
  std::vector<F> differences_;
  std::vector<Term> terms_;
  std::array<int, n + 1> terms_of_{};
};

}  // namespace servodx
