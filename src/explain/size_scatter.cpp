#include "explain/size_scatter.h"

#include <algorithm>

#include "evidence/constants.h"

namespace servodx {
namespace {

// Weighted line, or mean, through the sizes.
void pool(const std::vector<SizeOnLog>& sizes, bool line, SizeScatter& s) {
  double w = 0, wx = 0;
  for (const SizeOnLog& z : sizes) w += 1 / s.variance(z.square), wx += z.thickness / s.variance(z.square);
  s.middle = line ? wx / w : 0.0;
  double wy = 0, xx = 0, xy = 0;
  for (const SizeOnLog& z : sizes) {
    const double v = s.variance(z.square), x = z.thickness - s.middle;
    wy += z.size / v, xx += x * x / v, xy += x * z.size / v;
  }
  s.mean = wy / w, s.mean_variance = 1 / w;
  s.slope = line ? xy / xx : 0.0, s.slope_variance = line ? 1 / xx : 0.0;
  s.log_likelihood = 0;
  for (const SizeOnLog& z : sizes) {
    const double v = s.variance(z.square), off = z.size - s.at(z.thickness);
    s.log_likelihood -= std::log(v) + off * off / v;
  }
}

// About their weighted line, or mean.
SizeScatter scatter_about(const std::vector<SizeOnLog>& sizes, bool line) {
  const double n = static_cast<double>(sizes.size()), numbers = line ? 2 : 1;
  SizeScatter alike, in_proportion;
  pool(sizes, line, alike);
  double q = 0, w = 0, w2 = 0, w2xx = 0;  // Cochran's, and what it would be without scatter
  for (const SizeOnLog& z : sizes) {
    const double v = z.square + tiny, off = z.size - alike.at(z.thickness);
    const double x = line ? z.thickness - alike.middle : 0.0;  // a mean asks for no thickness, which may be unknown
    q += off * off / v, w += 1 / v, w2 += 1 / (v * v), w2xx += x * x / (v * v);
  }
  const double taken = w2 / w + w2xx * alike.slope_variance;
  in_proportion.phi2 = std::max(1.0, q / (n - numbers));
  pool(sizes, line, in_proportion);
  in_proportion.degrees = n - numbers;
  alike.tau2 = std::max(0.0, (q - (n - numbers)) / (w - taken));
  pool(sizes, line, alike);
  double squares = 0;
  for (const SizeOnLog& z : sizes) squares += 1 / std::pow(alike.variance(z.square), 2);
  alike.degrees =
      std::max(1.0, 1 / (alike.mean_variance * alike.mean_variance * squares) - numbers);  // logs that speak
  return in_proportion.log_likelihood > alike.log_likelihood ? in_proportion : alike;
}

}  // namespace

SizeScatter scatter_of(const std::vector<SizeOnLog>& sizes) {
  const SizeScatter mean = scatter_about(sizes, false);
  double low = 1e300, high = -1e300;
  for (const SizeOnLog& z : sizes) low = std::min(low, z.thickness), high = std::max(high, z.thickness);
  if (sizes.size() < evidence_constants::fewest_for_a_trend || !std::isfinite(low + high) || !(high > low)) return mean;
  for (const SizeOnLog& z : sizes)
    if (!std::isfinite(z.thickness)) return mean;
  const SizeScatter line = scatter_about(sizes, true);
  return line.log_likelihood - mean.log_likelihood > std::log(static_cast<double>(sizes.size())) ? line : mean;
}

}  // namespace servodx
