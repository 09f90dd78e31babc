// A failure mode's sub-group: a genetic search over what its hypothesis frees (GA paper, "Parameter finding approach":
// the group of parameters is divided in sub-groups, each with a failure mode identifier that initiates the model).
//
// The identifier is the mode's starting severities, the rest as health has it; half of the sub-population stands about
// it, half anywhere. Nothing of it is a derivative. Limits: it finds a basin; the local refinement ends in its minimum.
#pragma once
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"

namespace servodx {

// The attempt stands at the best of its sub-population thereafter. The same whatever the number of threads.
void evolve(Attempt& attempt, const HypothesisData& data, const HypothesisFit& health,
            const HypothesisSettings::Genetic& how);

}  // namespace servodx
