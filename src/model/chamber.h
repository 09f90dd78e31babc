// Oil that is shut in: how its pressure answers the flow into it.
#pragma once
#include "base/smooth.h"
#include "model/constants.h"
#include "model/hooks.h"

namespace servodx {

// A factor that is one where no effect asks for it.
struct One {};
template <class X>
X operator*(const X& x, One) {
  return x;
}

// Bulk modulus of the oil under pressure, over that without. [-]
template <class Effects, class P, class D>
inline __attribute__((always_inline)) auto stiffer(const P& pressure, const D& d) {
  using T = typename D::Scalar;
  if constexpr (stiffens_under_pressure(Effects{}))
    return T(1.0) + d.stiffening * pressure;
  else
    return One{};
}

// Stiffness of a chamber [Pa/m3]: oil, free air by the isothermal law, walls [m3/Pa], all in one fraction.
template <class Effects = EffectList<>, class V, class W, class P, class D>
auto chamber_stiffness(const V& volume, const W& walls, const P& pressure, const D& d) {
  using T = typename D::Scalar;
  namespace c = constants;
  const auto absolute = soft_positive(pressure + T(c::atmospheric_pressure), T(c::pressure_floor));
  const auto square = absolute * absolute;
  const auto oil = stiffer<Effects>(pressure, d);
  return square * oil * inverse((volume * d.inverse_bulk + walls * oil) * square + d.air * volume * oil);
}

}  // namespace servodx
