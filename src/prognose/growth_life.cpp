// Draws of the life left from a growth model: size, base, wander so far and to come, and where failure lies.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "base/random.h"
#include "prognose/constants.h"
#include "prognose/growth.h"
#include "prognose/growth_component.h"
#include "prognose/life.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Hours until the component passes the level; infinite where it never does, none where the draw is to the wrong side.
std::optional<double> hours_of(const GrowthComponent& c, const FailureAt& failure, const std::array<double, 5>& z,
                               double now, double length) {
  const double a = c.a + c.a_sd * z[0];
  const double base = c.base - c.tilt * (a - c.a) + c.base_sd * z[1];
  const double strayed = c.strayed + c.strayed_sd * z[2], ahead = z[3];
  const double moved = failure.sd * z[4];
  if (c.direction != 0 && a * c.direction <= 0) return {};
  const std::optional<double>& given = a > 0 ? failure.upper : failure.lower;
  if (!given || a == 0) return std::numeric_limits<double>::infinity();
  const double level = failure.level(*given, base, a / c.a * c.size());
  const auto reached = [&](double astray) {
    return std::max(0.0, c.onset + c.span * c.reaches(level, base, a, astray - moved) - now);
  };
  const double first = reached(strayed);
  if (!(c.wander > 0)) return first;
  // The wander goes on: once from now to the first estimate of the end.
  return reached(strayed + c.wander * std::sqrt(std::min(first, length) / length) * ahead);
}

}  // namespace

Life GrowthModel::life(const FailureAt& failure, std::uint64_t seed) const {
  std::vector<std::pair<double, double>> passed;  // hours, weight
  for (std::size_t k = 0; k < components_.size(); ++k) {
    const GrowthComponent& c = components_[k];
    Random random(seed, life_stream, static_cast<std::uint32_t>(k));
    const int draws = 2 * std::max(least_draws / 2, static_cast<int>(0.5 * all_draws * c.weight));
    std::vector<double> hours;
    std::array<double, 5> z{};
    for (int i = 0; i < most_tries * draws && std::ssize(hours) < draws; ++i) {
      // In pairs of opposite sign: the middle of a wide distribution is not left to chance.
      for (double& v : z) v = i % 2 ? -v : random.normal();
      if (const auto t = hours_of(c, failure, z, now_, length_)) hours.push_back(*t);
    }
    for (double t : hours) passed.emplace_back(t, c.weight / static_cast<double>(hours.size()));
  }
  std::sort(passed.begin(), passed.end());
  double total = 0;
  for (const auto& p : passed) total += p.second;
  return equally_likely(passed, total);
}

}  // namespace servodx
