// The fit of each fault: from its starts near an origin, then on while it may still come up to the best, the likeliest
// longest.
#pragma once
#include <vector>

#include "diagnose/fault_starts.h"
#include "diagnose/fit_steps.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "faults/fault.h"

namespace servodx {

// One attempt a fault, in the order of the list; `screened` from the same origin. `health`: its fit so far.
std::vector<Attempt> fit_faults(const Origin& origin, const std::vector<const Fault*>& faults,
                                const std::vector<Screened>& screened, const HypothesisFit& health,
                                const HypothesisData& data, FitSteps& steps);

// A fault that begins where bent health ended may stay in that valley. Where none leaves the log as a fault may, each
// is fitted from the table's values too, and the better fit stands. What is run for all is health's work.
void fit_faults_from_table(std::vector<Attempt>& attempts, const std::vector<const Fault*>& faults, Attempt& health,
                           const HypothesisData& data, FitSteps& steps);

}  // namespace servodx
