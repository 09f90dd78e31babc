// The middle of values: of an even number the upper one of the two in the middle.
#pragma once
#include <algorithm>
#include <vector>

namespace servodx {

// Of no values 0.
inline double median(std::vector<double> v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

// Of the deviations of normal values from their centre to their standard deviation.
inline constexpr double deviation_per_median = 1.4826;

}  // namespace servodx
