// How often one pressure lies below another.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace servodx {

// Part of the samples that both have in which `upper` lies below `lower` by more than margin(lower). Of no samples 0.
template <class Margin>
double part_below(const std::vector<double>& upper, const std::vector<double>& lower, Margin margin) {
  std::size_t below = 0, all = 0;
  for (std::size_t k = 0; k < std::min(upper.size(), lower.size()); ++k) {
    if (!std::isfinite(upper[k]) || !std::isfinite(lower[k])) continue;
    ++all;
    below += upper[k] < lower[k] - margin(lower[k]);
  }
  return all ? static_cast<double>(below) / static_cast<double>(all) : 0;
}

}  // namespace servodx
