// Forward derivatives whose sparsity is part of the type: Dual<T, Mask> carries a derivative slot only for the
// variables in Mask. An expression of several duals has the union of their masks, so the pattern of a Jacobian is
// known to the compiler, and no structural zero is ever computed.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include "base/pack.h"

namespace servodx {

// A set of variables 0 to 191: states, and whatever else a derivative is asked along. Three members, not an array: g++
// 12 confuses template arguments that hold one.
struct Mask {
  static constexpr int size = 192;
  std::uint64_t low = 0, middle = 0, high = 0;

  constexpr std::uint64_t part(int i) const { return i == 0 ? low : i == 1 ? middle : high; }
  friend constexpr bool operator==(const Mask&, const Mask&) = default;
  friend constexpr Mask operator|(const Mask& a, const Mask& b) {
    return {a.low | b.low, a.middle | b.middle, a.high | b.high};
  }
  friend constexpr Mask operator&(const Mask& a, const Mask& b) {
    return {a.low & b.low, a.middle & b.middle, a.high & b.high};
  }
  friend constexpr Mask operator~(const Mask& a) { return {~a.low, ~a.middle, ~a.high}; }
  constexpr Mask& operator|=(const Mask& b) { return *this = *this | b; }
  constexpr Mask& operator&=(const Mask& b) { return *this = *this & b; }
};
constexpr Mask only(int k) {
  const std::uint64_t bit = std::uint64_t{1} << k % 64;
  return {k < 64 ? bit : 0, k / 64 == 1 ? bit : 0, k / 64 == 2 ? bit : 0};
}
// Variables first to last - 1.
constexpr Mask range(int first, int last) {
  Mask m;
  for (int k = first; k < last; ++k) m |= only(k);
  return m;
}
constexpr bool holds(const Mask& m, int k) { return m.part(k / 64) >> k % 64 & 1u; }
constexpr int count(const Mask& m) { return std::popcount(m.low) + std::popcount(m.middle) + std::popcount(m.high); }

template <class T, Mask M>
struct Dual {
  static constexpr int slots = count(M);
  T v;
  std::array<T, slots> d;
};

// Slot of variable k in mask m.
constexpr int slot(const Mask& m, int k) { return count(m & range(0, k)); }

// The variable of the i-th slot of mask m.
constexpr int variable(const Mask& m, int i) {
  for (int j = 0; j < Mask::size / 64; ++j)
    for (std::uint64_t left = m.part(j); left; left &= left - 1)
      if (i-- == 0) return 64 * j + std::countr_zero(left);
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
Dual<T, only(K)> seed(T value, T derivative) {
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

namespace detail {
// f's derivative by variable K, by way of a and what follows it, which f has as its variables I, I + 1, ...
template <int K, int I, class T, Mask F, Mask A, class... Others>
inline __attribute__((always_inline)) auto by_way_of(const Dual<T, F>& f, const Dual<T, A>& a,
                                                     const Others&... others) {
  const auto later = [&] {
    if constexpr (sizeof...(Others) > 0)
      return by_way_of<K, I + 1>(f, others...);
    else
      return nullptr;
  }();
  constexpr bool adds = !std::is_same_v<decltype(later), const std::nullptr_t>;
  if constexpr (!holds(F, I) || !holds(A, K))
    return later;
  else if constexpr (adds)
    return multiply_add(f.d[slot(F, I)], a.d[slot(A, K)], later);
  else
    return f.d[slot(F, I)] * a.d[slot(A, K)];
}
template <Mask F, Mask... A>
constexpr Mask carried_mask() {
  Mask all = F & ~range(0, sizeof...(A));
  int i = 0;
  ((all = all | (holds(F, i++) ? A : Mask{})), ...);
  return all;
}
}  // namespace detail

// f was taken with the variables 0, 1, ... in place of those of `of`: its derivatives by what these depend on, and by
// what else it depended on itself.
template <class T, Mask F, Mask... A>
inline __attribute__((always_inline)) auto carried(const Dual<T, F>& f, const Dual<T, A>&... of) {
  constexpr Mask rest = F & ~range(0, sizeof...(A)), all = detail::carried_mask<F, A...>();
  Dual<T, all> r;
  r.v = f.v;
  unroll<Dual<T, all>::slots>([&](auto i) {
    constexpr int k = variable(all, i);
    const auto by_way = detail::by_way_of<k, 0>(f, of...);
    constexpr bool is_by_way = !std::is_same_v<decltype(by_way), const std::nullptr_t>;
    static_assert(is_by_way != holds(rest, k));
    if constexpr (is_by_way)
      r.d[i] = by_way;
    else
      r.d[i] = f.d[slot(F, k)];
  });
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
