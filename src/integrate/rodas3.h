// RODAS3: stiffly accurate, L-stable Rosenbrock method of order 3 in four stages (Sandu et al., Atmos. Environ. 31,
// 1997; coefficients also in Hairer & Wanner, Solving ODEs II, section IV.10). Fixed step; any state, no physics.
//
// The system supplies value, sparse Jacobian and time derivative in one call; the second stage reuses the first
// stage's derivative, so a step costs three evaluations (one of them with Jacobian), one factorisation, four solves.
#pragma once
#include <array>

#include "base/pack.h"
#include "integrate/sparse_lu.h"

namespace servodx {

// System: n; pattern (static constexpr Pattern<n>);
//   void value(const std::array<T,n>& y, const T& t, std::array<T,n>& f)
//   void value_and_jacobian(y, t, f, w, f_t): fills f, df/dt at fixed y, and w[slot(i,j)] = J(i,j) (0 on fill-in).
// t runs from 0 to h within the step. `see` is told the factors and the stages k1 to k4, each with its sign turned:
// y goes over y - 2 k1 and y - 2 k1 - k3, where the right-hand side is taken too, to y - 2 k1 - k3 - k4.
template <class T, class System, class See>
__attribute__((noinline)) void rodas3_step(System& system, std::array<T, System::n>& y, double h, See&& see) {
  constexpr int n = System::n;
  using Lu = SparseLu<n, System::pattern>;
  std::array<T, Lu::entries> w;
  std::array<T, n> f, f_t, k1, k2, k3, k4, z;
  system.value_and_jacobian(y, T(0.0), f, w, f_t);
  const T diagonal = T(2.0 / h);  // 1 / (gamma h), gamma = 1/2
  unroll<n>([&](auto i) { w[Lu::plan.slot[i][i]] = w[Lu::plan.slot[i][i]] - diagonal; });
  Lu::template factorise<T>(w);  // of J - I/(gamma h): the k below are the stages with their sign turned
  const T inv_h = T(1.0 / h), h_t = T(h), one = T(0.5 * h), three = T(1.5 * h), four = T(4.0 / h), two = T(2.0),
          eight = T(8.0 / (3.0 * h));
  unroll<n>([&](auto i) { k1[i] = multiply_add(one, f_t[i], f[i]); });
  Lu::template solve<T>(w, k1);
  unroll<n>([&](auto i) { k2[i] = subtract_product(multiply_add(three, f_t[i], f[i]), four, k1[i]); });
  Lu::template solve<T>(w, k2);
  unroll<n>([&](auto i) { z[i] = subtract_product(y[i], two, k1[i]); });
  system.value(z, h_t, f);
  unroll<n>([&](auto i) { k3[i] = multiply_add(inv_h, k2[i] - k1[i], f[i]); });
  Lu::template solve<T>(w, k3);
  unroll<n>([&](auto i) { z[i] = z[i] - k3[i]; });
  system.value(z, h_t, f);
  unroll<n>([&](auto i) { k4[i] = multiply_add(eight, k3[i], multiply_add(inv_h, k2[i] - k1[i], f[i])); });
  Lu::template solve<T>(w, k4);
  see(w, k1, k2, k3, k4);
  unroll<n>([&](auto i) { y[i] = z[i] - k4[i]; });
}
template <class T, class System>
void rodas3_step(System& system, std::array<T, System::n>& y, double h) {
  rodas3_step<T>(system, y, h, [](const auto&...) {});
}

}  // namespace servodx
