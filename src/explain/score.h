// Score test (Rao 1948): what a cause would remove of the misfit, told at the fit without it.
//
// The change that a probe of its size makes in the residual, less what the free numbers, priors included, can imitate,
// says how much the deviance would fall. All causes cost a few runs each. Exact for small sizes; of a large one it is
// what the probe itself removes. Says nothing of two causes together.
#pragma once
#include <functional>
#include <vector>

#include "explain/cause_score.h"
#include "explain/fit_causes.h"
#include "explain/subject.h"

namespace servodx {

// A score for each cause; without probes where `among` does not let it through. Empty: all.
std::vector<CauseScore> score_causes(const Subject& subject, const ExplainedFit& at,
                                     const std::function<bool(const Cause&)>& among = {});

}  // namespace servodx
