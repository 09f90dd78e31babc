#include "evidence/probabilities.h"

#include <algorithm>
#include <cmath>

namespace servodx {

double misfit_inflation(double best, double independent_samples) { return std::max(1.0, best / independent_samples); }

double misfit_scale(double healthy, double best, double independent_samples, double effect_error) {
  return misfit_inflation(best, independent_samples) +
         effect_error * effect_error * std::max(0.0, healthy - best) / independent_samples;
}

std::vector<double> probabilities_of(const std::vector<WeighedHypothesis>& hypotheses, double scale) {
  double least = 1e300;
  for (const WeighedHypothesis& h : hypotheses) least = std::min(least, h.misfit);
  std::vector<double> out;
  double total = 0;
  for (const WeighedHypothesis& h : hypotheses) {
    out.push_back(h.prior * std::exp(-0.5 * (h.misfit - least) / scale));
    total += out.back();
  }
  for (double& p : out) p = p / total;
  return out;
}

}  // namespace servodx
