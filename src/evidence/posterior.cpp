#include "evidence/posterior.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evidence/constants.h"

namespace servodx {
using namespace evidence_constants;

double factor_for_nothing(double chance) {
  if (chance >= 1 / std::numbers::e) return 1;
  return chance > 0 ? -std::numbers::e * chance * std::log(chance) : 0;
}

Posterior posterior_of(const PosteriorEvidence& e) {
  Posterior out;
  const double odds = factor_for_nothing(e.chance) / factor_for_nothing(e.rate);
  out.nothing = odds / (1 + odds);
  const double something = 1 - out.nothing;
  out.unlisted = something;
  if (e.worth.empty()) return out;
  const double best = *std::max_element(e.worth.begin(), e.worth.end());
  const double scale = 1 + effect_error * effect_error * std::max(0.0, best);
  double total = 0;
  for (const double worth : e.worth) total += out.causes.emplace_back(std::exp(-0.5 * (best - worth) / scale));
  const double listed = something * std::clamp(e.share_of_best, 0.0, 1.0);
  for (double& p : out.causes) p *= listed / total;
  out.unlisted = something - listed;
  return out;
}

}  // namespace servodx
