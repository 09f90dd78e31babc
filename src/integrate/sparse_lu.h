// LU factorisation of a sparse matrix whose pattern is known to the compiler: the order of elimination, the fill-in
// and every operation are computed at compile time; what runs is straight-line code without an index.
//
// No pivoting: meant for I/(h gamma) - J of a Rosenbrock step, whose diagonal carries the step. Elimination order:
// minimum degree (Markowitz count), ties by index.
#pragma once
#include <array>
#include <cstdint>
#include <utility>

#include "base/pack.h"
#include "base/sparse_dual.h"

namespace servodx {

template <int N>
struct Pattern {
  std::array<Mask, N> row{};  // bit j of row[i]: entry (i, j) may be non-zero
};

template <int N, Pattern<N> P>
struct SparseLu {
  struct Plan {
    std::array<int, N> order{};                // order[k]: the variable eliminated k-th
    std::array<Mask, N> filled{};              // pattern with fill-in, original numbering
    std::array<std::array<int, N>, N> slot{};  // storage position of (i, j), or -1
    int entries = 0;
  };
  static constexpr Plan make() {
    Plan plan;
    std::array<Mask, N> a = P.row;
    for (int i = 0; i < N; ++i) a[i] |= only(i);
    Mask left = range(0, N);
    for (int k = 0; k < N; ++k) {
      int best = -1;
      long best_cost = 0;
      for (int c = 0; c < N; ++c) {
        if (!holds(left, c)) continue;
        long rows = 0;
        for (int i = 0; i < N; ++i) rows += holds(left, i) && i != c && holds(a[i], c);
        const long columns = count(a[c] & left) - 1;
        const long cost = rows * columns;
        if (best < 0 || cost < best_cost) best = c, best_cost = cost;
      }
      plan.order[k] = best;
      left &= ~only(best);
      for (int i = 0; i < N; ++i)
        if (holds(left, i) && holds(a[i], best)) a[i] |= a[best] & left;
    }
    plan.filled = a;
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) plan.slot[i][j] = holds(a[i], j) ? plan.entries++ : -1;
    return plan;
  }
  static constexpr Plan plan = make();
  static constexpr int entries = plan.entries;

  struct Operation {
    std::int16_t kind;  // 0: w[a] = 1/w[a] (pivot);  1: w[a] = w[a]*w[b] (by a pivot);  2: w[a] -= w[b]*w[c]
    std::int16_t a, b, c;
  };
  static constexpr int count_operations() { return build<1>(nullptr); }
  template <int>
  static constexpr int build(Operation* out) {
    int n = 0;
    auto emit = [&](Operation op) {
      if (out) out[n] = op;
      ++n;
    };
    std::array<bool, N> done{};
    for (int k = 0; k < N; ++k) {
      const int p = plan.order[k];
      done[p] = true;
      emit({0, static_cast<std::int16_t>(plan.slot[p][p]), 0, 0});
      for (int i = 0; i < N; ++i) {
        if (done[i] || plan.slot[i][p] < 0) continue;
        const auto m = static_cast<std::int16_t>(plan.slot[i][p]);
        emit({1, m, static_cast<std::int16_t>(plan.slot[p][p]), 0});
        for (int j = 0; j < N; ++j)
          if (!done[j] && plan.slot[p][j] >= 0)
            emit({2, static_cast<std::int16_t>(plan.slot[i][j]), m, static_cast<std::int16_t>(plan.slot[p][j])});
      }
      // Both factors get a unit diagonal: a solve then waits for one product a level, not two.
      for (int j = 0; j < N; ++j)
        if (!done[j] && plan.slot[p][j] >= 0)
          emit({1, static_cast<std::int16_t>(plan.slot[p][j]), static_cast<std::int16_t>(plan.slot[p][p]), 0});
    }
    return n;
  }
  static constexpr int n_operations = count_operations();
  static constexpr std::array<Operation, n_operations> make_operations() {
    std::array<Operation, n_operations> ops{};
    build<0>(ops.data());
    return ops;
  }
  static constexpr std::array<Operation, n_operations> operations = make_operations();

  // Factorises in place. w holds the entries at plan.slot; on return the pivots are inverted.
  template <class T>
  static inline __attribute__((always_inline)) void factorise(std::array<T, entries>& w) {
    unroll<n_operations>([&](auto i) {
      constexpr Operation op = operations[i];
      if constexpr (op.kind == 0)
        w[op.a] = inverse(w[op.a]);
      else if constexpr (op.kind == 1)
        w[op.a] = w[op.a] * w[op.b];
      else
        w[op.a] = subtract_product(w[op.a], w[op.b], w[op.c]);
    });
  }

  // Solves in place with the factors of `factorise`; W: as T, or one number for all of T's lanes.
  template <class T, class W>
  static inline __attribute__((always_inline)) void solve(const std::array<W, entries>& w, std::array<T, N>& x) {
    unroll<N>([&](auto k) {
      constexpr int p = plan.order[k];
      unroll<N>([&](auto l) {
        constexpr int i = plan.order[l];
        if constexpr (l > k && plan.slot[i][p] >= 0) x[i] = subtract_product(x[i], T(w[plan.slot[i][p]]), x[p]);
      });
    });
    unroll<N>([&](auto k) { x[k] = x[k] * T(w[plan.slot[k][k]]); });
    unroll<N>([&](auto r) {
      constexpr int k = N - 1 - r;
      constexpr int p = plan.order[k];
      unroll<N>([&](auto l) {
        constexpr int j = plan.order[l];
        if constexpr (l > k && plan.slot[p][j] >= 0) x[p] = subtract_product(x[p], T(w[plan.slot[p][j]]), x[j]);
      });
    });
  }
};

}  // namespace servodx
