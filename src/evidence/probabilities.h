// Probabilities of hypotheses fitted to one log, from their misfits (-2 log likelihood) and prior weights.
//
// prior * exp(-(misfit - least) / (2 scale)), made to add up to one. The scale tempers: it is above 1 where even the
// best hypothesis fits worse than the error model says, and where the effect to be explained is large beside what a
// model of it is trusted for. The hypotheses are taken for exclusive and complete; that none of them holds is not
// asked.
#pragma once
#include <vector>

namespace servodx {

struct WeighedHypothesis {
  double prior = 1;
  double misfit = 0;
};

// 1 where the best misfit is what its independent samples make it, more where it is worse.
double misfit_inflation(double best, double independent_samples);

// The inflation, and what a model that errs by `effect_error` of its own effect leaves of the effect's misfit.
double misfit_scale(double healthy, double best, double independent_samples, double effect_error);

std::vector<double> probabilities_of(const std::vector<WeighedHypothesis>& hypotheses, double scale);

}  // namespace servodx
