// A pack of W doubles that computes like W scalars: one candidate a lane.
//
// Every operation is the IEEE operation of each lane (no fused multiply-add, no approximate root), so a lane equals
// the scalar run bit for bit. `Isa` only tags the type, so that code built for different instruction sets has
// different symbols.
#pragma once
#include <algorithm>
#include <cmath>

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
  friend Pack min(Pack a, Pack b) { return Pack(a.v < b.v ? a.v : b.v); }
  friend Pack max(Pack a, Pack b) { return Pack(a.v > b.v ? a.v : b.v); }
};

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

}  // namespace servodx
