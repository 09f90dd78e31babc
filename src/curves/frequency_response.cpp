#include "curves/frequency_response.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "base/two_pi.h"
#include "curves/constants.h"

namespace servodx::curves {
namespace {

using namespace curves_constants;

double between(double f0, double f1, double v0, double v1, double wanted) {
  const double part = v1 == v0 ? 0.0 : (wanted - v0) / (v1 - v0);
  return f0 * std::pow(f1 / f0, part);
}

}  // namespace

std::vector<ResponsePoint> frequency_response(std::span<const double> time, std::span<const double> input,
                                              std::span<const double> output, double coherence) {
  std::vector<ResponsePoint> points;
  const std::size_t n = time.size();
  if (n < 64) return points;
  const double span = time[n - 1] - time[0], rate = static_cast<double>(n - 1) / span;
  // Two windows at the lowest, five samples a cycle at the highest.
  const double lowest = 2.0 * cycles / span, highest = rate / 5.0;
  const int count = static_cast<int>(per_decade * std::log10(highest / lowest));
  double largest_input = 0.0;
  std::vector<double> power;
  for (int k = 0; k < count; ++k) {
    const double f = lowest * std::pow(10.0, static_cast<double>(k) / per_decade);
    const auto length = static_cast<std::size_t>(cycles / f * rate);
    double s_xx = 0, s_yy = 0;
    std::complex<double> s_xy = 0;
    int windows = 0;
    for (std::size_t first = 0; first + length <= n; first += std::max<std::size_t>(1, length / 4)) {
      double mean_x = 0, mean_y = 0;
      bool whole = true;
      for (std::size_t j = first; j < first + length; ++j) {
        whole = whole && std::isfinite(input[j]) && std::isfinite(output[j]);
        mean_x += input[j], mean_y += output[j];
      }
      if (!whole) continue;
      mean_x /= static_cast<double>(length), mean_y /= static_cast<double>(length);
      std::complex<double> x = 0, y = 0;
      for (std::size_t j = first; j < first + length; ++j) {
        const double part = static_cast<double>(j - first) / static_cast<double>(length);
        const double hann = 0.5 - 0.5 * std::cos(two_pi * part);
        const std::complex<double> turn = std::polar(hann, -two_pi * f * (time[j] - time[0]));
        x += turn * (input[j] - mean_x);
        y += turn * (output[j] - mean_y);
      }
      s_xx += std::norm(x), s_yy += std::norm(y), s_xy += std::conj(x) * y;
      ++windows;
    }
    if (windows < 2 || s_xx <= 0 || s_yy <= 0) continue;
    const double per = s_xx / (static_cast<double>(length) * static_cast<double>(length) * windows);
    largest_input = std::max(largest_input, per);
    const double c = std::norm(s_xy) / (s_xx * s_yy);
    if (c < coherence) continue;
    points.push_back({f, std::abs(s_xy) / s_xx, std::arg(s_xy), c});
    power.push_back(per);
  }
  std::vector<ResponsePoint> kept;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (power[k] > quiet_input * largest_input) kept.push_back(points[k]);
  for (std::size_t k = 1; k < kept.size(); ++k)
    kept[k].phase -= two_pi * std::round((kept[k].phase - kept[k - 1].phase) / two_pi);
  return kept;
}

double frequency_of_gain(std::span<const ResponsePoint> points, double ratio) {
  if (points.size() < 5) return std::numeric_limits<double>::quiet_NaN();
  double level = 0;
  for (int k = 0; k < 3; ++k) level += points[static_cast<std::size_t>(k)].gain / 3;
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k].gain < ratio * level && points[k - 1].gain >= ratio * level)
      return between(points[k - 1].frequency, points[k].frequency, points[k - 1].gain, points[k].gain, ratio * level);
  return std::numeric_limits<double>::quiet_NaN();
}

double frequency_of_lag(std::span<const ResponsePoint> points, double lag) {
  for (std::size_t k = 1; k < points.size(); ++k)
    if (points[k].phase < -lag && points[k - 1].phase >= -lag)
      return between(points[k - 1].frequency, points[k].frequency, points[k - 1].phase, points[k].phase, -lag);
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace servodx::curves
