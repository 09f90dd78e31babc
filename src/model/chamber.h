// Oil that is shut in: how its pressure answers the flow into it.
#pragma once
#include "base/smooth.h"
#include "model/constants.h"

namespace servodx {

// Stiffness of a chamber [Pa/m3]: oil, free air by the isothermal law, walls [m3/Pa], all in one fraction.
template <class V, class W, class P, class D>
auto chamber_stiffness(const V& volume, const W& walls, const P& pressure, const D& d) {
  using T = typename D::Scalar;
  namespace c = constants;
  const auto absolute = soft_positive(pressure + T(c::atmospheric_pressure), T(c::pressure_floor));
  const auto square = absolute * absolute;
  return square * inverse((volume * d.inverse_bulk + walls) * square + d.air * volume);
}

}  // namespace servodx
