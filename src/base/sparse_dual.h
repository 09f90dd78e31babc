// Forward derivatives whose sparsity is part of the type: Dual<T, Mask> carries a derivative slot only for the
// variables in Mask. An expression of several duals has the union of their masks, so the pattern of a Jacobian is
// known to the compiler, and no structural zero is ever computed.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "base/pack.h"

namespace servodx {

using Mask = std::uint32_t;

template <class T, Mask M>
struct Dual {
  static constexpr int slots = std::popcount(M);
  T v;
  std::array<T, slots> d;
};

// Slot of variable k in mask m.
constexpr int slot(Mask m, int k) { return std::popcount(m & ((Mask{1} << k) - 1)); }
constexpr bool holds(Mask m, int k) { return (m >> k) & 1u; }

// The variable of the i-th slot of mask m.
constexpr int variable(Mask m, int i) {
  for (int k = 0; k < 32; ++k)
    if (holds(m, k) && i-- == 0) return k;
  return -1;
}

namespace detail {
template <class F, int... I>
inline __attribute__((always_inline)) void each(F&& f, std::integer_sequence<int, I...>) {
  (f(std::integral_constant<int, I>{}), ...);
}
}  // namespace detail

// f(integral_constant<int, i>) for i in [0, N), unrolled.
template <int N, class F>
inline __attribute__((always_inline)) void unroll(F&& f) {
  detail::each(f, std::make_integer_sequence<int, N>{});
}

template <int K, class T>
Dual<T, Mask{1} << K> seed(T value, T derivative) {
  return {value, {derivative}};
}

// c = value, dc = ga*da + gb*db
template <class T, Mask A, Mask B>
inline __attribute__((always_inline)) Dual<T, A | B> chain(T value, const Dual<T, A>& a, T ga, const Dual<T, B>& b,
                                                           T gb) {
  Dual<T, A | B> r;
  r.v = value;
  unroll<Dual<T, A | B>::slots>([&](auto i) {
    constexpr int k = variable(A | B, i);
    if constexpr (holds(A, k) && holds(B, k))
      r.d[i] = multiply_add(ga, a.d[slot(A, k)], gb * b.d[slot(B, k)]);
    else if constexpr (holds(A, k))
      r.d[i] = ga * a.d[slot(A, k)];
    else
      r.d[i] = gb * b.d[slot(B, k)];
  });
  return r;
}
// c = value, dc = ga*da
template <class T, Mask A>
inline __attribute__((always_inline)) Dual<T, A> chain(T value, const Dual<T, A>& a, T ga) {
  Dual<T, A> r;
  r.v = value;
  unroll<Dual<T, A>::slots>([&](auto i) { r.d[i] = ga * a.d[i]; });
  return r;
}

template <class T, Mask A, Mask B>
Dual<T, A | B> operator+(const Dual<T, A>& a, const Dual<T, B>& b) {
  Dual<T, A | B> r;
  r.v = a.v + b.v;
  unroll<Dual<T, A | B>::slots>([&](auto i) {
    constexpr int k = variable(A | B, i);
    if constexpr (holds(A, k) && holds(B, k))
      r.d[i] = a.d[slot(A, k)] + b.d[slot(B, k)];
    else if constexpr (holds(A, k))
      r.d[i] = a.d[slot(A, k)];
    else
      r.d[i] = b.d[slot(B, k)];
  });
  return r;
}
template <class T, Mask A, Mask B>
Dual<T, A | B> operator-(const Dual<T, A>& a, const Dual<T, B>& b) {
  Dual<T, A | B> r;
  r.v = a.v - b.v;
  unroll<Dual<T, A | B>::slots>([&](auto i) {
    constexpr int k = variable(A | B, i);
    if constexpr (holds(A, k) && holds(B, k))
      r.d[i] = a.d[slot(A, k)] - b.d[slot(B, k)];
    else if constexpr (holds(A, k))
      r.d[i] = a.d[slot(A, k)];
    else
      r.d[i] = -b.d[slot(B, k)];
  });
  return r;
}
template <class T, Mask A, Mask B>
Dual<T, A | B> operator*(const Dual<T, A>& a, const Dual<T, B>& b) {
  return chain(a.v * b.v, a, b.v, b, a.v);
}
template <class T, Mask A, Mask B>
Dual<T, A | B> operator/(const Dual<T, A>& a, const Dual<T, B>& b) {
  const T inverse = T(1.0) / b.v;
  const T q = a.v / b.v;  // as the plain scalar computes it
  return chain(q, a, inverse, b, -q * inverse);
}
template <class T, Mask A>
Dual<T, A> operator-(const Dual<T, A>& a) {
  return chain(-a.v, a, T(-1.0));
}

template <class T, Mask A>
Dual<T, A> operator+(const Dual<T, A>& a, const std::type_identity_t<T>& c) {
  Dual<T, A> r = a;
  r.v = a.v + c;
  return r;
}
template <class T, Mask A>
Dual<T, A> operator+(const std::type_identity_t<T>& c, const Dual<T, A>& a) {
  Dual<T, A> r = a;
  r.v = c + a.v;
  return r;
}
template <class T, Mask A>
Dual<T, A> operator-(const Dual<T, A>& a, const std::type_identity_t<T>& c) {
  Dual<T, A> r = a;
  r.v = a.v - c;
  return r;
}
template <class T, Mask A>
Dual<T, A> operator-(const std::type_identity_t<T>& c, const Dual<T, A>& a) {
  return chain(c - a.v, a, T(-1.0));
}
template <class T, Mask A>
Dual<T, A> operator*(const Dual<T, A>& a, const std::type_identity_t<T>& c) {
  return chain(a.v * c, a, c);
}
template <class T, Mask A>
Dual<T, A> operator*(const std::type_identity_t<T>& c, const Dual<T, A>& a) {
  return chain(c * a.v, a, c);
}
template <class T, Mask A>
Dual<T, A> operator/(const Dual<T, A>& a, const std::type_identity_t<T>& c) {
  return chain(a.v / c, a, T(1.0) / c);
}
template <class T, Mask A>
Dual<T, A> operator/(const std::type_identity_t<T>& c, const Dual<T, A>& a) {
  const T q = c / a.v;
  return chain(q, a, -q / a.v);
}
template <class T, Mask A>
Dual<T, A> sqrt(const Dual<T, A>& a) {
  using std::sqrt;
  const T r = sqrt(a.v);
  return chain(r, a, T(0.5) / r);
}
template <class T, Mask A>
Dual<T, A> root(const Dual<T, A>& a) {
  const auto [r, y] = both_roots(a.v);
  return chain(r, a, T(0.5) * y);
}
template <class T, Mask A>
Dual<T, A> inverse(const Dual<T, A>& a) {
  const T y = inverse(a.v);
  return chain(y, a, -y * y);
}
template <class T, Mask A>
Dual<T, A> inverse_root(const Dual<T, A>& a) {
  const T y = inverse_root(a.v);
  return chain(y, a, T(-0.5) * y * y * y);
}
template <class T, Mask A>
Roots<Dual<T, A>> both_roots(const Dual<T, A>& a) {
  const auto [r, y] = both_roots(a.v);
  const T half = T(0.5) * y;
  return {chain(r, a, half), chain(y, a, -half * y * y)};
}

}  // namespace servodx
