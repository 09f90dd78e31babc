#include "evidence/log_scatter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/student.h"
#include "evidence/constants.h"

namespace servodx {
using namespace evidence_constants;

double Deviate::chance_above() const { return t > 0 ? 0.5 * student_tail(t, degrees) : 1.0; }

Deviate deviate_of(double value, const std::vector<double>& healthy, UsualSpread usual, double error) {
  std::vector<double> logs;
  for (const double v : healthy)
    if (v > 0) logs.push_back(std::log(v));
  if (logs.size() < fewest_of_spread || !(value > 0)) return {};
  const auto n = static_cast<double>(logs.size());
  double mean = 0, square = usual.logs * usual.of_logarithm * usual.of_logarithm;
  for (const double v : logs) mean += v / n;
  for (const double v : logs) square += (v - mean) * (v - mean);
  const double degrees = n - 1 + usual.logs;
  const double spread = std::sqrt(std::max(least_variance, square / degrees) * (1 + 1 / n) + error * error);
  return {(std::log(value) - mean) / spread, degrees};
}

}  // namespace servodx
