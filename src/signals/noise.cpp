#include "signals/noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/median.h"

namespace servodx {

double noise_of(const std::vector<double>& x, double resolution) {
  std::vector<double> d;
  for (std::size_t k = 2; k + 2 < x.size(); ++k) {
    const double v = x[k - 2] - 4 * x[k - 1] + 6 * x[k] - 4 * x[k + 1] + x[k + 2];
    if (!std::isnan(v)) d.push_back(std::abs(v));
  }
  const double quantisation = resolution / std::sqrt(12.0);
  if (d.empty()) return quantisation;
  // Median of |N(0,1)| is 0.6745; the fourth difference of white noise has variance 70.
  return std::max(median(std::move(d)) / (0.6745 * std::sqrt(70.0)), quantisation);
}

}  // namespace servodx
