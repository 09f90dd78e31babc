// A pack of W doubles: one candidate a lane. Lanes do not see each other, so a candidate has the same bits in any lane
// beside any neighbours. `Isa` tags the type, so that code built for different instruction sets has different symbols.
//
// The hot loop is bound by the divider, which takes 16 to 32 cycles for eight doubles where a multiplication takes a
// half. So it asks for `inverse_root` and `inverse`: where the instruction set fuses multiply and add (Isa 2: AVX2 and
// FMA, 5: AVX-512) they are a first guess and one or two steps of third order, right to eleven digits;
// elsewhere they are the IEEE root and quotient. So instruction sets differ in the last digits (docs/performance.md).
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#if defined(__AVX2__) || defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace servodx {

template <int W>
struct VectorOf;
template <>
struct VectorOf<2> {
  typedef double type __attribute__((vector_size(16)));
};
template <>
struct VectorOf<4> {
  typedef double type __attribute__((vector_size(32)));
};
template <>
struct VectorOf<8> {
  typedef double type __attribute__((vector_size(64)));
};

template <int W, int Isa = 0>
struct Pack {
  static constexpr int lanes = W;
  static constexpr bool refined = (W == 8 && Isa == 5) || (W == 4 && Isa == 2);
  using Vector = typename VectorOf<W>::type;
  Vector v;

  Pack() = default;
  Pack(double x) : v(Vector{} + x) {}  // every lane; implicit so that formulas read the same for all scalars
  explicit Pack(Vector x) : v(x) {}
  double operator[](int lane) const { return v[lane]; }
  void set(int lane, double x) { v[lane] = x; }

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
  // a*b + c and c - a*b, fused where the machine can.
  friend Pack multiply_add(Pack a, Pack b, Pack c) { return fused<false>(a, b, c); }
  friend Pack subtract_product(Pack c, Pack a, Pack b) { return fused<true>(a, b, c); }
  // 1/sqrt(a), a > 0 and normal.
  friend Pack inverse_root(Pack a) {
    if constexpr (refined) {
      // y(1 + e/2 + 3e^2/8), e = 1 - a y^2, leaves 5e^3/16: 6e-13 after one step from a guess of 14 bits, 3e-12
      // after two from one of 3.5 %. A model's steps err by 1e-4.
      Pack y = guess_root(a);
      for (int i = 0; i < (Isa == 5 ? 1 : 2); ++i) {
        const Pack e = subtract_product(1.0, a * y, y);
        y = multiply_add(multiply_add(Pack(0.375), e, Pack(0.5)), y * e, y);
      }
      return y;
    } else {
      return Pack(1.0) / sqrt(a);
    }
  }
  // 1/a, a normal.
  friend Pack inverse(Pack a) {
    if constexpr (refined && Isa == 5) {
      Pack y = guess_inverse(a);
      const Pack e = subtract_product(1.0, a, y);  // below 2^-14; y(1 + e + e^2) leaves e^3
      return multiply_add(y, multiply_add(e, e, e), y);
    } else {
      return Pack(1.0) / a;
    }
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
#if defined(__AVX512F__)
    if constexpr (W == 8 && Isa == 5) return Pack(Vector(_mm512_maskz_min_pd(0xff, a.v, b.v)));
#endif
    return Pack(a.v < b.v ? a.v : b.v);
  }
  friend Pack max(Pack a, Pack b) {
#if defined(__AVX512F__)
    if constexpr (W == 8 && Isa == 5) return Pack(Vector(_mm512_maskz_max_pd(0xff, a.v, b.v)));
#endif
    return Pack(a.v > b.v ? a.v : b.v);
  }

 private:
  template <bool Negative>
  static Pack fused(Pack a, Pack b, Pack c) {
#if defined(__AVX512F__)
    if constexpr (W == 8 && Isa == 5)
      return Pack(Vector(Negative ? _mm512_fnmadd_pd(a.v, b.v, c.v) : _mm512_fmadd_pd(a.v, b.v, c.v)));
    else
#endif
#if defined(__FMA__)
        if constexpr (W == 4 && Isa == 2)
      return Pack(Vector(Negative ? _mm256_fnmadd_pd(a.v, b.v, c.v) : _mm256_fmadd_pd(a.v, b.v, c.v)));
    else
#endif
      return Negative ? c - a * b : a * b + c;
  }
  static Pack guess_root(Pack a) {
#if defined(__AVX512F__)
    if constexpr (W == 8 && Isa == 5)
      return Pack(Vector(_mm512_maskz_rsqrt14_pd(0xff, a.v)));
    else
#endif
    {  // half the exponent, and a line for the mantissa (Lomont 2003): within 3.5 %
      typedef std::int64_t Bits __attribute__((vector_size(8 * W)));
      return Pack(Vector((Bits{} + 0x5fe6eb50c7b537a9) - (Bits(a.v) >> 1)));
    }
  }
  static Pack guess_inverse(Pack a) {
#if defined(__AVX512F__)
    if constexpr (W == 8 && Isa == 5) return Pack(Vector(_mm512_maskz_rcp14_pd(0xff, a.v)));
#endif
    return Pack(1.0) / a;
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
template <int W, int Isa>
Roots<Pack<W, Isa>> both_roots(const Pack<W, Isa>& a) {
  if constexpr (Pack<W, Isa>::refined) {
    const Pack<W, Isa> y = inverse_root(a);
    return {a * y, y};
  } else {
    const Pack<W, Isa> r = sqrt(a);
    return {r, Pack<W, Isa>(1.0) / r};
  }
}

template <class T>
struct Lanes {
  static constexpr int count = 1;
  static double get(const T& x, int) { return x; }
  static void set(T& x, int, double value) { x = value; }
};
template <int W, int Isa>
struct Lanes<Pack<W, Isa>> {
  static constexpr int count = W;
  static double get(const Pack<W, Isa>& x, int lane) { return x[lane]; }
  static void set(Pack<W, Isa>& x, int lane, double value) { x.set(lane, value); }
};
template <class T>
void take_lane(T& to, const T& from, int lane) {
  Lanes<T>::set(to, lane, Lanes<T>::get(from, lane));
}

}  // namespace servodx
