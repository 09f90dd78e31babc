#include "report/shared/plot_samples.h"

#include <algorithm>
#include <numeric>

namespace servodx::report {

std::vector<std::size_t> thinned(std::span<const double> x, std::span<const std::vector<double>* const> series,
                                 std::size_t most) {
  const std::size_t n = x.size();
  std::vector<std::size_t> kept;
  if (n <= most) {
    kept.resize(n);
    std::iota(kept.begin(), kept.end(), std::size_t{0});
    return kept;
  }
  const std::size_t per_bucket = 2 + 2 * series.size();
  const std::size_t buckets = std::max<std::size_t>(1, most / per_bucket);
  const double width = (x[n - 1] - x[0]) / static_cast<double>(buckets);
  std::vector<std::size_t> bucket;
  for (std::size_t b = 0, begin = 0; b < buckets && begin < n; ++b) {
    const double end_x = x[0] + width * static_cast<double>(b + 1);
    std::size_t end = begin;
    while (end < n && (b + 1 == buckets || x[end] < end_x)) ++end;
    if (end == begin) continue;
    bucket = {begin, end - 1};
    for (const std::vector<double>* y : series) {
      std::size_t low = n, high = n;  // NaN compares false: it is never an extreme
      for (std::size_t k = begin; k < end; ++k) {
        if ((*y)[k] != (*y)[k]) continue;
        if (low == n || (*y)[k] < (*y)[low]) low = k;
        if (high == n || (*y)[k] > (*y)[high]) high = k;
      }
      if (low < n) bucket.insert(bucket.end(), {low, high});
    }
    std::sort(bucket.begin(), bucket.end());
    bucket.erase(std::unique(bucket.begin(), bucket.end()), bucket.end());
    kept.insert(kept.end(), bucket.begin(), bucket.end());
    begin = end;
  }
  return kept;
}

}  // namespace servodx::report
