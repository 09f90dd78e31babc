#include "prognose/growth_component.h"

#include <algorithm>
#include <cstddef>

namespace servodx {

double GrowthComponent::grown(double time) const {
  if (!of_drop) return along(time);
  return lost > 0 ? drop_beyond_whole(lost * along(time)) / drop_beyond_whole(lost) : 0.0;
}

double GrowthComponent::by_oil(const GrowthPoint& p) const {
  double sum = 0;
  for (std::size_t j = 0; j < std::min<std::size_t>(2, p.features.size()); ++j)
    sum += d[static_cast<long>(j)] * p.features[j];
  return sum * (of_drop ? 1 + drop_beyond_whole(lost * along(p.time)) : along(p.time));
}

double GrowthComponent::slope_now() const {
  if (!of_drop) return a * law.slope_at_1() / span;
  const double drop = 1 + drop_beyond_whole(lost);
  return lost > 0 ? a / (drop - 1) * drop_per_lost(drop) * lost * law.slope_at_1() / span : 0.0;
}

double GrowthComponent::reaches(double level, double from, double growth, double astray) const {
  if (!of_drop) return law.inverse(std::max(0.0, (level - astray - from) / growth));
  const double drop = 1 + (level - from) / growth * drop_beyond_whole(lost);
  return law.inverse(std::max(0.0, drop > 1 ? lost_at_drop(drop) - astray : 0.0) / lost);
}

}  // namespace servodx
