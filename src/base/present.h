// Figures of values of which some may be missing: of those that are there, the finite ones.
#pragma once
#include <cmath>
#include <cstddef>
#include <vector>

namespace servodx {

inline std::vector<double> present(const std::vector<double>& x) {
  std::vector<double> out;
  for (const double v : x)
    if (std::isfinite(v)) out.push_back(v);
  return out;
}

// Mean of value(k), k from `first` to below `end`. NaN: none is there.
template <class Value>
double mean_of_present(std::size_t first, std::size_t end, const Value& value) {
  double sum = 0;
  std::size_t n = 0;
  for (std::size_t k = first; k < end; ++k)
    if (const double v = value(k); std::isfinite(v)) sum += v, ++n;
  return n > 0 ? sum / static_cast<double>(n) : std::nan("");
}
inline double mean_of_present(const std::vector<double>& x) {
  return mean_of_present(0, x.size(), [&](std::size_t k) { return x[k]; });
}

// Root of the mean square. 0: none is there.
inline double rms_of_present(const std::vector<double>& x) {
  const double square = mean_of_present(0, x.size(), [&](std::size_t k) { return x[k] * x[k]; });
  return std::isnan(square) ? 0.0 : std::sqrt(square);
}

}  // namespace servodx
