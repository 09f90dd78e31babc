#include "prognose/growth_data.h"

#include <algorithm>
#include <utility>

#include "prognose/growth_law.h"

namespace servodx {
namespace {

// The oil's viscosity and its square where both are known; none where it changes no growth.
long features_of_oil(const GrowthPrior& prior, std::size_t added) {
  if (!(prior.tilt > 0)) return 0;
  return prior.feature_mean.size() >= 2 ? 2 : std::min(static_cast<long>(added), 1L);
}

}  // namespace

GrowthData::GrowthData(std::vector<GrowthPoint> in_order, const GrowthPrior& prior) : points(std::move(in_order)) {
  const auto size = static_cast<long>(points.size());
  first = points.front().time;
  now = points.back().time;
  length = std::max(now - first, 1e-12);
  for (std::size_t j = 0; j < prior.feature_mean.size(); ++j)
    if (prior.feature_sd[j] > 0) added.push_back(j);
  const auto f = static_cast<long>(added.size()), oil = features_of_oil(prior, added.size());
  terms.resize(size, f + 1), drift.resize(size, size), by_oil.resize(size, oil);
  for (Eigen::VectorXd* v : {&y, &variance, &exposed, &stretch}) v->resize(size);
  mean.resize(f + 1), sd.resize(f + 1);
  mean[0] = prior.base, sd[0] = prior.base_sd;
  for (long j = 0; j < f; ++j)
    mean[j + 1] = prior.feature_mean[added[static_cast<std::size_t>(j)]],
             sd[j + 1] = prior.feature_sd[added[static_cast<std::size_t>(j)]];
  for (long i = 0; i < size; ++i) {
    const GrowthPoint& p = points[static_cast<std::size_t>(i)];
    y[i] = p.y, variance[i] = p.variance, exposed[i] = p.exposed, stretch[i] = p.stretch, terms(i, 0) = p.base_shown;
    for (long j = 0; j < f; ++j) terms(i, j + 1) = p.features[added[static_cast<std::size_t>(j)]];
    for (long j = 0; j < oil; ++j) by_oil(i, j) = p.features[static_cast<std::size_t>(j)];
    for (long k = 0; k <= i; ++k)
      drift(i, k) = drift(k, i) = (points[static_cast<std::size_t>(k)].time - first) / length;
  }
  worn = prior.of_drop ? lost_at_drop(1 + prior.scale) : prior.scale;
}

}  // namespace servodx
