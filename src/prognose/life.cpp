#include "prognose/life.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

double life_quantile(const Life& life, double p) {
  const double at = p * static_cast<double>(life.size()) - 0.5;
  const auto last = static_cast<double>(life.size()) - 1;
  const double low = std::floor(std::clamp(at, 0.0, last));
  const double high = std::min(low + 1, last);
  const double a = life[static_cast<std::size_t>(low)], b = life[static_cast<std::size_t>(high)];
  const double part = std::clamp(at, 0.0, last) - low;
  return part == 0 ? a : a + part * (b - a);
}

Remaining remaining_of(const Life& life, double coverage) {
  return {life_quantile(life, 0.5), life_quantile(life, 0.5 - coverage / 2), life_quantile(life, 0.5 + coverage / 2)};
}

Life equally_likely(const std::vector<std::pair<double, double>>& weighted, double total) {
  Life life;
  double sum = 0;
  std::size_t i = 0;
  for (int q = 0; q < life_hours && !weighted.empty(); ++q) {
    const double target = (q + 0.5) / life_hours * total;
    while (i + 1 < weighted.size() && sum + weighted[i].second < target) sum += weighted[i].second, ++i;
    life.push_back(weighted[i].first);
  }
  return life;
}

}  // namespace servodx
