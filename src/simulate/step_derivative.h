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
#include <memory>
#include <span>
#include <vector>

#include "base/pack.h"
#include "base/sparse_dual.h"
#include "integrate/sparse_lu.h"
#include "model/asperities.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "simulate/kernel.h"
#include "simulate/scenario.h"
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

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

// One step of the run that is followed.
template <class Effects>
struct TakenStep {
  static constexpr int n = Variables<Effects>::n, entries = Gradient<double, Effects>::entries;
  using Lu = SparseLu<n, System<double, Effects, false>::pattern>;
  // What multiplies an entry's variable at each stage, then the entry at z and z'.
  enum { stage_1, stage_2, stage_3, stage_4, at_z, at_z2, width = 8 };

  double after, h;           // [s] since the sample; its length
  std::array<double, n> to;  // the state after it
  Inputs<double> at, slope;
  alignas(64) float g[entries][width];
  std::array<float, Lu::entries> lu;
};

// Keeps the steps of a run from some samples to the next. All lanes of T are the same candidate.
template <class T, class Effects>
struct StepRecorder : Unwatched {
  using Step = TakenStep<Effects>;
  static constexpr int n = Step::n, lanes = Lanes<T>::count;
  static constexpr double epsilon = 1e-4;

  std::vector<int> wanted;  // entries that somebody asks for

  // Of the steps that are kept: all, to how many samples, and those to the k-th of them.
  int steps() const { return static_cast<int>(count_); }
  std::size_t samples() const { return ends_.size(); }
  std::span<const Step> steps_to(std::size_t k) const {
    const std::size_t first = k ? ends_[k - 1] : 0;
    return {steps_.data() + first, ends_[k] - first};
  }
  void forget() { ends_.clear(), count_ = 0; }
  void sample() { ends_.push_back(count_); }

  static double of(const T& x) { return Lanes<T>::get(x, 0); }
  static Inputs<double> of(const Inputs<T>& u) {
    Inputs<double> out{of(u.current), of(u.supply_pressure), of(u.return_pressure), of(u.load_force)};
    const FrictionMemory<T>& f = u.friction;
    FrictionMemory<double>& to = out.friction;
    to.spool_anchor = of(f.spool_anchor), to.spool_speed = of(f.spool_speed), to.rod_speed = of(f.rod_speed);
    for (std::size_t i = 0; i < to.seal_anchor.size(); ++i) to.seal_anchor[i] = of(f.seal_anchor[i]);
    to.seal_breakaway = of(f.seal_breakaway), to.seal_per_reach = of(f.seal_per_reach);
    return out;
  }

  void interval() { count_ = sample_begins(); }
  template <class W>
  void step(const System<T, Effects, false>& live, const std::array<T, n>& y, double h, const W& w,
            const std::array<T, n>& k1, const std::array<T, n>& k2, const std::array<T, n>& k3,
            const std::array<T, n>& k4) {
    if (count_ == steps_.size()) steps_.emplace_back();
    Step& s = steps_[count_];
    s.after = h * static_cast<double>(count_ - sample_begins());
    s.h = h;
    s.at = of(live.at);
    s.slope = of(live.slope);
    for (int e = 0; e < Step::Lu::entries; ++e) s.lu[e] = static_cast<float>(of(w[e]));
    // Points: y moved against each stage, z, z', y, and nothing.
    constexpr double by[4][8] = {{epsilon, 0, 0, 0, 2, 2, 0, 0},
                                 {0, epsilon, 0, 0, 0, 0, 0, 0},
                                 {0, 0, epsilon, 0, 0, 1, 0, 0},
                                 {0, 0, 0, epsilon, 0, 0, 0, 0}};
    constexpr double when[8] = {0.5 * epsilon, 1.5 * epsilon, 0, 0, 1, 1, 0, 0};  // of h, as df/dt enters the stages
    std::array<T, Step::entries> raw[8 / lanes];
    for (int first = 0; first < 8; first += lanes) {
      const auto those = [&](const double* values) {
        T x;
        for (int lane = 0; lane < lanes; ++lane) Lanes<T>::set(x, lane, values[first + lane]);
        return x;
      };
      const T b1 = those(by[0]), b2 = those(by[1]), b3 = those(by[2]), b4 = those(by[3]), t = those(when) * T(h);
      std::array<T, n> point;
      for (int i = 0; i < n; ++i) {
        const T one = subtract_product(subtract_product(y[i], b1, k1[i]), b2, k2[i]);
        point[i] = subtract_product(subtract_product(one, b3, k3[i]), b4, k4[i]);
      }
      const Inputs<T>&at = live.at, &slope = live.slope;
      const Inputs<T> u{at.current + slope.current * t, at.supply_pressure + slope.supply_pressure * t,
                        at.return_pressure + slope.return_pressure * t, at.load_force + slope.load_force * t,
                        at.friction};
      Gradient<T, Effects>::at(point, u, live.p, live.d, raw[first / lanes]);
    }
    typedef double D __attribute__((vector_size(64)));
    typedef float F __attribute__((vector_size(32)));
    constexpr double e = 1.0 / epsilon;
    for (const int k : wanted) {
      D g;
      if constexpr (lanes == 8)
        g = raw[0][k].v;
      else
        g = __builtin_shufflevector(raw[0][k].v, raw[1][k].v, 0, 1, 2, 3, 4, 5, 6, 7);
      const D at_y = __builtin_shufflevector(g, g, 6, 6, 6, 6, 6, 6, 6, 6),
              base = __builtin_shufflevector(g, g, 6, 6, 4, 5, 4, 5, 6, 6);
      const F r = __builtin_convertvector(base + D{e, e, e, e, 0, 0, 0, 0} * (g - at_y), F);
      __builtin_memcpy(s.g[k], &r, sizeof r);
    }
  }
  void taken(const std::array<T, n>& y, const FrictionMemory<T>&, const FrictionMemory<T>&) {
    Step& s = steps_[count_++];
    for (int i = 0; i < n; ++i) s.to[i] = of(y[i]);
  }

 private:
  std::size_t sample_begins() const { return ends_.empty() ? 0 : ends_.back(); }

  std::vector<Step> steps_;
  std::vector<std::size_t> ends_;  // of the steps to each sample
  std::size_t count_ = 0;
};

// A difference that dies away ends below the normal floats, where arithmetic takes a hundred times as long: zero there.
class FlushTiny {
 public:
#if defined(__SSE2__)
  FlushTiny() : before_(_mm_getcsr()) { _mm_setcsr(before_ | 0x8040); }
  ~FlushTiny() { _mm_setcsr(before_); }
#else
  FlushTiny() = default;
#endif
  FlushTiny(const FlushTiny&) = delete;

 private:
  unsigned before_ = 0;
};

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

// T: packs of doubles in which the runs are; F: of floats, twice as many.
template <class T, class F, class Effects>
class RunAndFollowers : public NearRuns {
 public:
  using G = Gradient<double, Effects>;

  static std::unique_ptr<NearRuns> make(const Scenario& in, const ParameterVector& base, Trajectory& of_base,
                                        const ParameterVector* const* candidates, Trajectory* const* results, int count,
                                        const SimulateOptions& options) {
    return std::make_unique<RunAndFollowers>(in, base, of_base, candidates, results, count, options);
  }
  RunAndFollowers(const Scenario& in, const ParameterVector& base, Trajectory& of_base,
                  const ParameterVector* const* candidates, Trajectory* const* results, int count,
                  const SimulateOptions& options)
      : results_(results, results + count), base_(&base), of_base_(&of_base), run_(in, &base_, &of_base_, 1, options) {
    for (int first = 0; first < count; first += F::lanes)
      followers_.push_back(std::make_unique<Followers<T, F, Effects>>(
          run_, in, candidates + first, results_.data() + first, std::min(count - first, F::lanes), options));
    std::array<bool, G::entries> wanted{};
    for (int i = 0; i < G::n; ++i) std::fill_n(wanted.begin() + G::layout.first[i], G::layout.moving[i], true);
    for (const auto& f : followers_) run_.sticks |= f->sticks(), f->ask_for(wanted);
    // Breakaway is followed by all or none: what it remembers is compared.
    for (const auto& f : followers_)
      if (run_.sticks) f->stick();
    for (auto& r : recorded_)
      for (int e = 0; e < G::entries; ++e)
        if (wanted[e]) r.wanted.push_back(e);
  }

  int followers() const override { return static_cast<int>(followers_.size()); }
  bool lead(int steps) override {
    auto& r = recorded_[next_];
    r.forget();
    while (r.steps() < steps && run_.under_way()) run_.next(r), r.sample();
    return r.samples() > 0;
  }
  void follow(int f) override {
    const FlushTiny flush;
    const auto& r = recorded_[1 - next_];
    for (std::size_t k = 0; k < r.samples(); ++k) followers_[f]->next(r.steps_to(k));
  }
  void turn() override { next_ = 1 - next_; }
  void end() override {
    if (!of_base_->ok)
      for (Trajectory* t : results_)
        if (t->ok) t->ok = false, t->failed_at = of_base_->failed_at;
  }

 private:
  std::vector<Trajectory*> results_;
  const ParameterVector* base_;
  Trajectory* of_base_;
  Run<T, Effects> run_;
  std::vector<std::unique_ptr<Followers<T, F, Effects>>> followers_;
  std::array<StepRecorder<T, Effects>, 2> recorded_;
  int next_ = 0;
};

}  // namespace servodx
