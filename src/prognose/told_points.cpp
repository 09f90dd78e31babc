#include "prognose/told_points.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "base/median.h"
#include "base/tiny.h"
#include "prognose/constants.h"
#include "prognose/reading_scale.h"

namespace servodx {

using namespace prognose_constants;

namespace {

double median_of_neighbours(const std::vector<double>& y, std::size_t i) {
  std::vector<double> near;
  for (std::size_t k = i >= neighbours ? i - neighbours : 0; k < std::min(y.size(), i + neighbours + 1); ++k)
    if (k != i) near.push_back(y[k]);
  return median(near);
}

// What the oil may change of a check, and what of its figure a unit of wear is there.
void expose(std::vector<GrowthPoint>& points, const GrowthPrior& prior) {
  std::vector<double> y;
  for (const GrowthPoint& p : points) y.push_back(p.y);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double near = median_of_neighbours(y, i), drop = std::max(near, 1.0);
    points[i].exposed = std::abs((prior.of_drop ? drop : near - prior.base) * points[i].features[0]);
    if (prior.of_drop) points[i].stretch = 1 / ReadingScale::lost_per_drop(drop);
  }
}

// A drop is tried in many parts lost: where only the curve through the checks is asked for, in fewer.
GrowthPrior first_look(GrowthPrior prior) {
  prior.coarse = prior.of_drop;
  return prior;
}

// Where the scale of what is lost ends a reading says: at most this. The normal reading that says as much to the curve
// that all tell together (Newton's step of the likelihood of a censored reading).
std::vector<GrowthPoint> at_the_end(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  const std::vector<GrowthPoint> as_read = points;
  const auto at_most = [](const GrowthPoint& p) { return p.at_most; };
  for (int k = 0; k < newton_steps && std::any_of(as_read.begin(), as_read.end(), at_most); ++k) {
    const GrowthModel all(thinned(points), first_look(prior));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const GrowthPoint& p = as_read[i];
      if (!p.at_most) continue;
      const double sigma = std::hypot(std::sqrt(p.variance), all.growth().noise);
      const double curve = all.expected(p), z = (p.y - curve) / sigma;
      const double ratio = std::exp(-0.5 * z * z) * std::numbers::sqrt2 / std::sqrt(std::numbers::pi) /
                           std::max(std::erfc(-z / std::numbers::sqrt2), tiny);
      const double bend = std::clamp(ratio * (z + ratio), least_bend, 1.0);
      points[i].y = curve - sigma * ratio / bend;
      points[i].variance = p.variance + sigma * sigma * (1 / bend - 1);
    }
  }
  return points;
}

// One check alone raises no alert: what lies far from its neighbours, before and after it, weighs as little as it is
// far from them, until others join it. Their spread is that of all checks about their neighbours.
std::vector<GrowthPoint> set_aside(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  expose(points, prior);
  const GrowthModel first(thinned(points), first_look(prior));
  std::vector<double> corrected;
  for (const GrowthPoint& p : points) corrected.push_back(first.at_reference(p));
  std::vector<double> away;
  for (std::size_t i = 0; i < points.size(); ++i)
    away.push_back(std::abs(corrected[i] - median_of_neighbours(corrected, i)));
  const double spread = std::max(deviation_per_median * median(away), tiny);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (away[i] > outlying * std::hypot(spread, std::sqrt(points[i].variance))) points[i].variance += away[i] * away[i];
  return points;
}

}  // namespace

std::vector<GrowthPoint> thinned(const std::vector<GrowthPoint>& points) {
  if (points.size() <= most_points) return points;
  std::vector<GrowthPoint> out;
  for (std::size_t b = 0; b < most_points; ++b) {
    const std::size_t from = b * points.size() / most_points, to = (b + 1) * points.size() / most_points;
    GrowthPoint mean;
    mean.features.assign(points[from].features.size(), 0.0);
    const auto n = static_cast<double>(to - from);
    for (std::size_t i = from; i < to; ++i) {
      mean.exposed += points[i].exposed / n, mean.stretch += (points[i].stretch - 1) / n;
      mean.base_shown += (points[i].base_shown - 1) / n;
      mean.time += points[i].time / n, mean.y += points[i].y / n, mean.variance += points[i].variance / n / n;
      for (std::size_t j = 0; j < mean.features.size(); ++j) mean.features[j] += points[i].features[j] / n;
    }
    out.push_back(std::move(mean));
  }
  return out;
}

std::vector<GrowthPoint> told_points(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  return at_the_end(set_aside(std::move(points), prior), prior);
}

}  // namespace servodx
