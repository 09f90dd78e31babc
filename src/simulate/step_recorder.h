// The steps of a run, kept for those that follow it (simulate/followers.h): where each began and ended, its factors,
// and the gradient of its right-hand side as its stages need it.
//
// dW k is the difference of G at y and at y - epsilon k, over -epsilon: G is wanted at seven points, which stand in the
// lanes of packs. Good to the first order of epsilon; factors and gradients are kept as floats, as they multiply
// differences alone. All lanes of the run are one candidate. Source: differentiation of the stages of
// integrate/rodas3.h by hand.
#pragma once
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "base/pack.h"
#include "integrate/sparse_lu.h"
#include "model/asperities.h"
#include "model/state.h"
#include "simulate/gradient.h"
#include "simulate/pack_run.h"
#include "simulate/system.h"

namespace servodx {

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

}  // namespace servodx
