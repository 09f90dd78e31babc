// Wilson's score interval of a rate that was counted. Source: E. B. Wilson, J. Am. Stat. Assoc. 22 (1927) 209.
//
// Holds for independent trials; unlike the normal interval it keeps its coverage near 0 and 1 and for few trials.
#pragma once
#include <algorithm>
#include <cmath>

namespace servodx {

struct RateInterval {
  double lower = 0, upper = 1;  // [fraction] without trials: all that can be
};

inline RateInterval wilson_95(double counted, double trials) {
  if (!(trials > 0)) return {};
  constexpr double z = 1.959963984540054;  // two-sided 95 % of the normal distribution
  const double p = counted / trials, grown = 1 + z * z / trials;
  const double centre = (p + z * z / (2 * trials)) / grown;
  const double half = z / grown * std::sqrt(p * (1 - p) / trials + z * z / (4 * trials * trials));
  return {std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

}  // namespace servodx
