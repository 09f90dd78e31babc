#include "prognose/healthy_levels.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "base/median.h"
#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// x with P(|N(0,1)| > x) = p.
double two_sided_quantile(double p) {
  double low = 0, high = 40;
  for (int k = 0; k < 80; ++k) {
    const double mid = 0.5 * (low + high);
    (std::erfc(mid / std::numbers::sqrt2) > p ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

}  // namespace

HealthyChecks healthy_checks(const Growth& whole, bool confirmed, const Growth& begun,
                             std::span<const GrowthPoint> first, std::span<const double> corrected) {
  std::vector<double> own;
  for (const GrowthPoint& p : first) own.push_back(p.variance);
  const double noise = begun.probability < 0.5 ? begun.null_noise : begun.noise;
  return {confirmed ? whole.base : median({corrected.begin(), corrected.end()}),
          std::sqrt(noise * noise * (1 + 1.0 / static_cast<double>(first.size())) + median(own))};
}

HealthyLevels healthy_levels(const HealthyChecks& checks, const ReadingScale& scale, int direction, std::size_t names,
                             double false_alarm) {
  const auto band = [&](double rate) {
    const double q = two_sided_quantile(rate) * checks.spread;
    Level l = scale.out(checks.centre - q, checks.centre + q);
    if (direction > 0) l.lower.reset();
    if (direction < 0) l.upper.reset();
    return l;
  };
  return {band(false_alarm), band(false_alarm / (per_checks * static_cast<double>(names)))};
}

Level warned_in_time(const Level& warning, const Level& failure, const HealthyChecks& checks,
                     const ReadingScale& scale) {
  Level out = warning;
  const auto in_time = [&](std::optional<double>& level, const std::optional<double>& end, double side) {
    if (!end) return;
    const double latest = scale.out(checks.centre + scale.worn(latest_warning, scale.in(*end) - checks.centre));
    if (!level || side * (*level - latest) > 0) level = latest;
  };
  in_time(out.upper, failure.upper, 1);
  in_time(out.lower, failure.lower, -1);
  return out;
}

}  // namespace servodx
