// The middle of values, of an even number the upper one of the two; and the value that a part of them lies below.
#pragma once
#include <algorithm>
#include <vector>

namespace servodx {

// Of no values 0. In place: in another order afterwards, and no memory is asked for.
inline double median_in_place(std::vector<double>& v) {
  if (v.empty()) return 0;
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}
inline double median(std::vector<double> v) { return median_in_place(v); }

// The value at this part of the way through the sorted values, between two of them the lower one. Of no values 0.
inline double quantile(std::vector<double> v, double part) {
  if (v.empty()) return 0;
  const auto at = v.begin() + static_cast<long>(part * static_cast<double>(v.size() - 1));
  std::nth_element(v.begin(), at, v.end());
  return *at;
}

// Of the deviations of normal values from their centre to their standard deviation.
inline constexpr double deviation_per_median = 1.4826;

}  // namespace servodx
