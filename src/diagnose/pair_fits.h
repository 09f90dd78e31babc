// A second fault beside a leading one: which pairs may gain, and their fits.
#pragma once
#include <vector>

#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "faults/fault.h"
#include "fit/fit_work.h"

namespace servodx {

// The pairs that came nearest, fitted by derivatives of their own; empty where no pair could gain. `singles`: health
// and the faults as each was fitted alone.
std::vector<HypothesisFit> fit_pairs(const std::vector<const Fault*>& faults, const HypothesisData& data,
                                     const HypothesisFits& singles, FitWork& work);

}  // namespace servodx
