// A pack of W numbers: one candidate a lane. Lanes do not see each other, so a candidate has the same bits in any lane
// beside any neighbours. `Isa` tags the type, so that code built for different instruction sets has different symbols.
// Packs of floats are twice as wide; they serve to rank candidates, never for what is reported.
//
// A divider takes 16 to 32 cycles for eight doubles where a multiplication takes a half. So the hot loop asks for
// `inverse_root` and `inverse`: where the instruction set fuses multiply and add (Isa 2: AVX2 and FMA, 5: AVX-512) they
// are a first guess and one or two steps, right to eleven digits (floats: to their last bits); elsewhere they are the
// IEEE root and quotient. So instruction sets differ in the last digits (docs/performance.md).
#pragma once
#include <algorithm>
#include <cmath>
#include <type_traits>
#if defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace servodx {

// What an instruction set has for its full registers beyond plain arithmetic. Guesses: of 1/sqrt(a) and 1/a.
template <int Isa, class Real>
struct Machine {
  static constexpr int lanes = 0;  // this translation unit is not built for it
};
#if defined(__AVX2__) && defined(__FMA__)
template <>
struct Machine<2, double> {
  using V = __m256d;
  static constexpr int lanes = 4, root_steps = 2;
  static constexpr bool guesses_inverse = false, has_min = false;
  static V add_product(V a, V b, V c) { return _mm256_fmadd_pd(a, b, c); }
  static V less_product(V a, V b, V c) { return _mm256_fnmadd_pd(a, b, c); }
  static V guess_root(V a) {  // half the exponent, and a line for the mantissa (Lomont 2003): within 3.5 %
    return V(_mm256_sub_epi64(_mm256_set1_epi64x(0x5fe6eb50c7b537a9), _mm256_srli_epi64(__m256i(a), 1)));
  }
};
template <>
struct Machine<2, float> {
  using V = __m256;
  static constexpr int lanes = 8, root_steps = 1;
  static constexpr bool guesses_inverse = true, has_min = false;
  static V add_product(V a, V b, V c) { return _mm256_fmadd_ps(a, b, c); }
  static V less_product(V a, V b, V c) { return _mm256_fnmadd_ps(a, b, c); }
  static V guess_root(V a) { return _mm256_rsqrt_ps(a); }  // of 12 bits
  static V guess_inverse(V a) { return _mm256_rcp_ps(a); }
};
#endif
#if defined(__AVX512F__)
template <>
struct Machine<5, double> {
  using V = __m512d;
  static constexpr int lanes = 8, root_steps = 1;
  static constexpr bool guesses_inverse = true, has_min = true;
  static V add_product(V a, V b, V c) { return _mm512_fmadd_pd(a, b, c); }
  static V less_product(V a, V b, V c) { return _mm512_fnmadd_pd(a, b, c); }
  static V guess_root(V a) { return _mm512_maskz_rsqrt14_pd(0xff, a); }  // of 14 bits
  static V guess_inverse(V a) { return _mm512_maskz_rcp14_pd(0xff, a); }
  static V min(V a, V b) { return _mm512_maskz_min_pd(0xff, a, b); }
  static V max(V a, V b) { return _mm512_maskz_max_pd(0xff, a, b); }
};
template <>
struct Machine<5, float> {
  using V = __m512;
  static constexpr int lanes = 16, root_steps = 1;
  static constexpr bool guesses_inverse = true, has_min = true;
  static V add_product(V a, V b, V c) { return _mm512_fmadd_ps(a, b, c); }
  static V less_product(V a, V b, V c) { return _mm512_fnmadd_ps(a, b, c); }
  static V guess_root(V a) { return _mm512_maskz_rsqrt14_ps(0xffff, a); }
  static V guess_inverse(V a) { return _mm512_maskz_rcp14_ps(0xffff, a); }
  static V min(V a, V b) { return _mm512_maskz_min_ps(0xffff, a, b); }
  static V max(V a, V b) { return _mm512_maskz_max_ps(0xffff, a, b); }
};
#endif

template <int W, int Isa = 0, class Real = double>
struct Pack {
  using Its = Machine<Isa, Real>;
  static constexpr int lanes = W;
  static constexpr bool refined = W == Its::lanes;
  typedef Real Vector __attribute__((vector_size(W * sizeof(Real))));
  Vector v;

  Pack() = default;
  Pack(double x)
      : v(static_cast<Real>(x) - Vector{}) {
  }  // every lane (less 0 folds away); implicit so that formulas read the same for all scalars
  explicit Pack(Vector x) : v(x) {}
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double x) { v[lane] = static_cast<Real>(x); }

  friend Pack operator+(Pack a, Pack b) { return Pack(a.v + b.v); }
  friend Pack operator-(Pack a, Pack b) { return Pack(a.v - b.v); }
  friend Pack operator*(Pack a, Pack b) { return Pack(a.v * b.v); }
  friend Pack operator/(Pack a, Pack b) { return Pack(a.v / b.v); }
  friend Pack operator-(Pack a) { return Pack(-a.v); }
  Pack& operator+=(Pack b) {
    v += b.v;
    return *this;
  }
  Pack& operator-=(Pack b) {
    v -= b.v;
    return *this;
  }
  Pack& operator*=(Pack b) {
    v *= b.v;
    return *this;
  }
  friend Pack sqrt(Pack a) {
    Pack r;
    for (int i = 0; i < W; ++i) r.v[i] = std::sqrt(a.v[i]);  // one vector instruction
    return r;
  }
  friend Pack exp(Pack a) {
    Pack r;
    for (int i = 0; i < W; ++i) r.v[i] = std::exp(a.v[i]);  // a few times a run
    return r;
  }
  // a*b + c and c - a*b, fused where the machine can.
  friend Pack multiply_add(Pack a, Pack b, Pack c) {
    if constexpr (refined)
      return Pack(Vector(Its::add_product(a.v, b.v, c.v)));
    else
      return a * b + c;
  }
  friend Pack subtract_product(Pack c, Pack a, Pack b) {
    if constexpr (refined)
      return Pack(Vector(Its::less_product(a.v, b.v, c.v)));
    else
      return c - a * b;
  }
  // 1/sqrt(a), a > 0 and normal.
  friend Pack inverse_root(Pack a) {
    if constexpr (refined) {
      // With e = 1 - a y^2, y(1 + e/2 + 3e^2/8) leaves 5e^3/16: 6e-13 after one step from a guess of 14 bits, 3e-12
      // after two from one of 3.5 %; a model's steps err by 1e-4. y(1 + e/2) leaves 3e^2/8: 2e-7 from 12 bits.
      Pack y = Pack(Vector(Its::guess_root(a.v)));
      for (int i = 0; i < Its::root_steps; ++i) {
        const Pack e = subtract_product(1.0, a * y, y);
        if constexpr (std::is_same_v<Real, float>)
          y = multiply_add(Pack(0.5) * y, e, y);
        else
          y = multiply_add(multiply_add(Pack(0.375), e, Pack(0.5)), y * e, y);
      }
      return y;
    } else {
      return Pack(1.0) / sqrt(a);
    }
  }
  // 1/a, a normal.
  friend Pack inverse(Pack a) {
    if constexpr (refined) {
      if constexpr (Its::guesses_inverse) {
        const Pack y = Pack(Vector(Its::guess_inverse(a.v)));
        const Pack e = subtract_product(1.0, a, y);  // y(1 + e + e^2) leaves e^3, below 2^-42; y(1 + e) leaves e^2
        if constexpr (std::is_same_v<Real, float>)
          return multiply_add(y, e, y);
        else
          return multiply_add(y, multiply_add(e, e, e), y);
      }
    }
    return Pack(1.0) / a;
  }
  // sqrt(a), a > 0 and normal.
  friend Pack root(Pack a) {
    if constexpr (refined)
      return a * inverse_root(a);
    else
      return sqrt(a);
  }
  // One instruction each, where a comparison and a choice would be two; the same bits, b where either is no number.
  friend Pack min(Pack a, Pack b) {
    if constexpr (refined)
      if constexpr (Its::has_min) return Pack(Vector(Its::min(a.v, b.v)));
    return Pack(a.v < b.v ? a.v : b.v);
  }
  friend Pack max(Pack a, Pack b) {
    if constexpr (refined)
      if constexpr (Its::has_min) return Pack(Vector(Its::max(a.v, b.v)));
    return Pack(a.v > b.v ? a.v : b.v);
  }
};

// The same for a scalar, or any number with a root: the IEEE operations.
template <class T>
T multiply_add(const T& a, const T& b, const T& c) {
  return a * b + c;
}
template <class T>
T subtract_product(const T& c, const T& a, const T& b) {
  return c - a * b;
}
template <class T>
T root(const T& a) {
  using std::sqrt;
  return sqrt(a);
}
template <class T>
T inverse(const T& a) {
  return T(1.0) / a;
}
template <class T>
T inverse_root(const T& a) {
  using std::sqrt;
  return T(1.0) / sqrt(a);
}

// Root and inverse root, for the price of one.
template <class T>
struct Roots {
  T root, inverse;
};
template <class T>
Roots<T> both_roots(const T& a) {
  const T r = root(a);
  return {r, T(1.0) / r};
}
template <int W, int Isa, class Real>
Roots<Pack<W, Isa, Real>> both_roots(const Pack<W, Isa, Real>& a) {
  using P = Pack<W, Isa, Real>;
  if constexpr (P::refined) {
    const P y = inverse_root(a);
    return {a * y, y};
  } else {
    const P r = sqrt(a);
    return {r, P(1.0) / r};
  }
}

template <class T>
struct Lanes {
  static constexpr int count = 1;
  static double get(const T& x, int) { return x; }
  static void set(T& x, int, double value) { x = value; }
};
template <int W, int Isa, class Real>
struct Lanes<Pack<W, Isa, Real>> {
  static constexpr int count = W;
  static double get(const Pack<W, Isa, Real>& x, int lane) { return x[lane]; }
  static void set(Pack<W, Isa, Real>& x, int lane, double value) { x.set(lane, value); }
};
template <class T>
void take_lane(T& to, const T& from, int lane) {
  Lanes<T>::set(to, lane, Lanes<T>::get(from, lane));
}

}  // namespace servodx
