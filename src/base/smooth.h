// Smooth stand-ins for the kinks of hydraulics: no branch, and finite derivatives everywhere. Each takes the width over
// which it rounds its kink: by a hyperbola, off by less than one part in a hundred of the width ten widths away, or by
// a parabola, exact beyond the width and cheaper, with a slope that has corners. Duals get the derivative that costs
// least: one inverse root gives the root and its slope.
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

// max(x, 0) once more: a parabola within `width` of zero and exactly 0 below. For contacts, where the tail of
// soft_positive, times a great stiffness, would reach far.
template <class X>
X contact_depth(const X& x, double width) {
  using std::max, std::min;
  const X begun = max(X(0.0), min(x + X(width), X(2.0 * width)));
  return begun * begun * X(0.25 / width) + max(X(0.0), x - X(width));
}
template <class T, Mask A>
Dual<T, A> contact_depth(const Dual<T, A>& x, double width) {
  using std::max, std::min;
  return chain(contact_depth(x.v, width), x, max(T(0.0), min(x.v + T(width), T(2.0 * width))) * T(0.5 / width));
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

// |x|, its corner kept: for what it only scales, so that the whole is smooth without a width.
template <class X>
X magnitude(const X& x) {
  using std::max;
  return max(x, -x);
}
template <class T, Mask A>
Dual<T, A> magnitude(const Dual<T, A>& x) {
  using std::max, std::min;
  return chain(magnitude(x.v), x, max(T(-1.0), min(T(1.0), x.v * T(1e30))));
}

// x beyond a gap of half width `half` on either side of zero, corners rounded within `width`: exactly 0 in the gap, and
// x at half = 0.
template <class X, class H>
auto dead_zone(const X& x, const H& half, double width) {
  return contact_depth(x - half, width) - contact_depth(-x - half, width);
}

// x kept within +-limit, corners rounded within `width`; exactly x well inside.
template <class X, class L>
auto saturate(const X& x, const L& limit, double width) {
  return x - dead_zone(x, limit, width);
}

// From -1 at x = -1 to 1 at x = 1 and exactly flat beyond, two derivatives continuous: (15 x - 10 x^3 + 3 x^5) / 8.
template <class X>
X flat_step(const X& x) {
  using std::max, std::min;
  const X c = max(min(x, X(1.0)), X(-1.0)), c2 = c * c;
  return c * (X(1.875) - c2 * (X(1.25) - X(0.375) * c2));
}
template <class T, Mask A>
Dual<T, A> flat_step(const Dual<T, A>& x) {
  using std::max, std::min;
  const T c = max(min(x.v, T(1.0)), T(-1.0)), rest = T(1.0) - c * c;
  return chain(flat_step(x.v), x, T(1.875) * (rest * rest));
}

// sign(dp) sqrt(|dp|) behind a laminar resistance in series: x that solves |dp| = x^2 + 2 l x, with the sign of dp,
// linear within `transition` of zero. At l = 0 it is dp / (dp^2 + transition^2)^(1/4).
template <class P, class L, class W>
auto signed_sqrt_behind(const L& l, const P& dp, const W& transition) {
  const auto [r, y] = both_roots(dp * dp + transition * transition);
  return (root(l * l + r) - l) * (dp * y);
}
template <class T, Mask A>
Dual<T, A> signed_sqrt_behind(const std::type_identity_t<T>& l, const Dual<T, A>& dp,
                              const std::type_identity_t<T>& transition) {
  const auto [r, y] = both_roots(dp.v * dp.v + transition * transition);
  const auto [whole, z] = both_roots(l * l + r);
  const T s = dp.v * y, x = whole - l;
  return chain(x * s, dp, T(0.5) * z * s * s + x * y * (T(1.0) - s * s));
}

}  // namespace servodx
