// Smooth stand-ins for the kinks of hydraulics: no branch, and finite derivatives everywhere. Each takes the width over
// which it rounds its kink; far from the kink (ten widths) the error is below one part in a hundred of the width.
// Duals get the derivative that costs least: one inverse root gives the root and its slope.
#pragma once
#include <algorithm>
#include <cmath>

#include "base/pack.h"
#include "base/sparse_dual.h"

namespace servodx {

// |x|, rounded within `width` of zero; never below width.
template <class X, class W>
auto smooth_abs(const X& x, const W& width) {
  return root(x * x + width * width);
}
template <class T, Mask A>
Dual<T, A> smooth_abs(const Dual<T, A>& x, const std::type_identity_t<T>& width) {
  const auto [r, y] = both_roots(x.v * x.v + width * width);
  return chain(r, x, x.v * y);
}

// max(x, 0), rounded within `width` of zero; width/2 at zero.
template <class X, class W>
auto soft_positive(const X& x, const W& width) {
  return (x + smooth_abs(x, width)) * 0.5;
}

// -1..1 in place of the sign of x; 0.7 at x = width.
template <class X, class W>
auto smooth_sign(const X& x, const W& width) {
  return x * inverse_root(x * x + width * width);
}
template <class T, Mask A>
Dual<T, A> smooth_sign(const Dual<T, A>& x, const std::type_identity_t<T>& width) {
  const T y = inverse_root(x.v * x.v + width * width), s = x.v * y;
  return chain(s, x, y * (T(1.0) - s * s));
}

// x beyond a gap of half width `half` on either side of zero, corners rounded within `width`. Exactly x at half = 0.
template <class X, class H, class W>
auto dead_zone(const X& x, const H& half, const W& width) {
  return x - (smooth_abs(x + half, width) - smooth_abs(x - half, width)) * 0.5;
}

// x kept within +-limit, corners rounded within `width`.
template <class X, class L, class W>
auto saturate(const X& x, const L& limit, const W& width) {
  return (smooth_abs(x + limit, width) - smooth_abs(x - limit, width)) * 0.5;
}

// The same with corners that are parabolas within `width` of the limit: exact beyond, and no root. Its slope has
// corners.
template <class X, class T>
auto blunt_saturate(const X& x, const T& limit, const T& width) {
  using std::max, std::min;
  const X a = max(X(-width), min(X(width), x + limit)), b = max(X(-width), min(X(width), x - limit));
  return ((a - b) * (x - (a + b) * T(0.5)) + (a + b) * limit) * (T(0.5) / width);
}
template <class T, Mask A>
Dual<T, A> blunt_saturate(const Dual<T, A>& x, const T& limit, const T& width) {
  using std::max, std::min;
  const T a = max(-width, min(width, x.v + limit)), b = max(-width, min(width, x.v - limit)), per = T(0.5) / width;
  return chain(((a - b) * (x.v - (a + b) * T(0.5)) + (a + b) * limit) * per, x, (a - b) * per);
}

// sign(dp) sqrt(|dp|), linear within `transition` of zero: dp / (dp^2 + transition^2)^(1/4).
template <class P, class W>
auto signed_sqrt(const P& dp, const W& transition) {
  return dp * inverse_root(smooth_abs(dp, transition));
}
template <class T, Mask A>
Dual<T, A> signed_sqrt(const Dual<T, A>& dp, const std::type_identity_t<T>& transition) {
  const auto [r, y] = both_roots(dp.v * dp.v + transition * transition);
  const T z = inverse_root(r), s = dp.v * y;
  return chain(dp.v * z, dp, z * (T(1.0) - T(0.5) * s * s));
}

}  // namespace servodx
