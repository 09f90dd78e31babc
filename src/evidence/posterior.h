// What is likely wrong, given how rarely healthy logs look so and how well each cause does: probabilities over the
// causes, something that no cause of the list names, and nothing.
//
// Nothing: by the least Bayes factor that a chance p allows, -e p ln p (Sellke, Bayarri & Berger 2001), at odds
// beforehand that come out even where the verdict turns, so that no probability contradicts it. What is left goes to
// the list as far as its best cause removes the misfit, and else to what is not listed. Among the listed, weights fall
// with the misfit; a cause's model is trusted to a tenth of its effect, so that a large effect does not make a small
// difference certain.
#pragma once
#include <vector>

namespace servodx {

// Odds of nothing over something that a chance p allows at most, at even odds beforehand; 1 from 1/e on.
double factor_for_nothing(double chance);

struct PosteriorEvidence {
  double chance = 1;          // that a healthy log looks as unlike health, all questions counted
  double rate = 1;            // chance at which the verdict turns
  double share_of_best = 0;   // of the held-out misfit, that the best cause removes
  std::vector<double> worth;  // of each cause: fall of -2 log likelihood, numbers paid (BIC)
};

struct Posterior {
  std::vector<double> causes;
  double unlisted = 0, nothing = 1;
};

Posterior posterior_of(const PosteriorEvidence& evidence);

}  // namespace servodx
