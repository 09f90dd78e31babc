#include "prognose/cause_rule.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "prognose/constants.h"

namespace servodx {

using namespace prognose_constants;

namespace {

double weight_of(const Life& life, double coverage) {
  const Remaining r = remaining_of(life, coverage);
  const double width =
      std::isfinite(r.upper) ? std::max(r.upper - r.lower, least_width) : open_width * std::max(1.0, r.lower);
  return 1 / (width * width);
}

}  // namespace

std::optional<std::size_t> cause_of(const std::vector<CauseEvidence>& checks) {
  double furthest = -std::numeric_limits<double>::infinity();
  for (const CauseEvidence& c : checks)
    if (c.tracked && c.predicted) furthest = std::max(furthest, c.surely);
  std::optional<std::size_t> cause;
  for (std::size_t k = 0; k < checks.size(); ++k) {
    const CauseEvidence& c = checks[k];
    const bool may_be = c.tracked && c.predicted && c.surely >= std::min(furthest, as_far * furthest);
    if (may_be && (!cause || c.log_bayes_factor > checks[*cause].log_bayes_factor)) cause = k;
  }
  return cause;
}

Life pooled(const std::vector<const Life*>& lives, double coverage) {
  std::vector<std::pair<double, double>> all;
  double total = 0;
  for (const Life* life : lives) {
    const double weight = weight_of(*life, coverage);
    for (double t : *life) all.emplace_back(t, weight / static_cast<double>(life->size())), total += all.back().second;
  }
  std::sort(all.begin(), all.end());
  return equally_likely(all, total);
}

}  // namespace servodx
