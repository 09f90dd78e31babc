// RODAS3: stiffly accurate, L-stable Rosenbrock method of order 3 in four stages (Sandu et al., Atmos. Environ. 31,
// 1997; coefficients also in Hairer & Wanner, Solving ODEs II, section IV.10). Fixed step; any state, no physics.
//
// The system supplies value, sparse Jacobian and time derivative in one call; the second stage reuses the first
// stage's derivative, so a step costs three evaluations (one of them with Jacobian), one factorisation, four solves.
#pragma once
#include <array>

#include "integrate/sparse_lu.h"

namespace servodx {

// System: n; pattern (static constexpr Pattern<n>);
//   void value(const std::array<T,n>& y, const T& t, std::array<T,n>& f)
//   void value_and_jacobian(y, t, f, w, f_t): fills f, df/dt at fixed y, and w[slot(i,j)] = -J(i,j) (0 on fill-in).
// t runs from 0 to h within the step.
template <class T, class System>
inline __attribute__((always_inline)) void rodas3_step(System& system, std::array<T, System::n>& y, double h) {
  constexpr int n = System::n;
  using Lu = SparseLu<n, System::pattern>;
  std::array<T, Lu::entries> w;
  std::array<T, n> f, f_t, k1, k2, k3, k4, z;
  system.value_and_jacobian(y, T(0.0), f, w, f_t);
  const T diagonal = T(2.0 / h);  // 1 / (gamma h), gamma = 1/2
  unroll<n>([&](auto i) { w[Lu::plan.slot[i][i]] = w[Lu::plan.slot[i][i]] + diagonal; });
  Lu::template factorise<T>(w);
  const T inv_h = T(1.0 / h), h_t = T(h);
  for (int i = 0; i < n; ++i) k1[i] = f[i] + T(0.5) * h_t * f_t[i];
  Lu::template solve<T>(w, k1);
  for (int i = 0; i < n; ++i) k2[i] = f[i] + T(4.0) * inv_h * k1[i] + T(1.5) * h_t * f_t[i];
  Lu::template solve<T>(w, k2);
  for (int i = 0; i < n; ++i) z[i] = y[i] + T(2.0) * k1[i];
  system.value(z, h_t, f);
  for (int i = 0; i < n; ++i) k3[i] = f[i] + inv_h * (k1[i] - k2[i]);
  Lu::template solve<T>(w, k3);
  for (int i = 0; i < n; ++i) z[i] = z[i] + k3[i];
  system.value(z, h_t, f);
  for (int i = 0; i < n; ++i) k4[i] = f[i] + inv_h * (k1[i] - k2[i] - T(8.0 / 3.0) * k3[i]);
  Lu::template solve<T>(w, k4);
  for (int i = 0; i < n; ++i) y[i] = z[i] + k4[i];
}

}  // namespace servodx
