// Smooth stand-ins for the kinks of hydraulics, built from square roots and divisions only: no branch, and finite
// derivatives everywhere. Each takes the width over which it rounds its kink; far from the kink (ten widths) the error
// is below one part in a hundred of the width.
#pragma once
#include <cmath>

namespace servodx {

// |x|, rounded within `width` of zero; never below width.
template <class X, class W>
auto smooth_abs(const X& x, const W& width) {
  using std::sqrt;
  return sqrt(x * x + width * width);
}

// max(x, 0), rounded within `width` of zero; width/2 at zero.
template <class X, class W>
auto soft_positive(const X& x, const W& width) {
  return (x + smooth_abs(x, width)) * 0.5;
}

// -1..1 in place of the sign of x; 0.7 at x = width.
template <class X, class W>
auto smooth_sign(const X& x, const W& width) {
  return x / smooth_abs(x, width);
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

// sign(dp) sqrt(|dp|), linear within `transition` of zero: dp / (dp^2 + transition^2)^(1/4).
template <class P, class W>
auto signed_sqrt(const P& dp, const W& transition) {
  using std::sqrt;
  return dp / sqrt(smooth_abs(dp, transition));
}

}  // namespace servodx
