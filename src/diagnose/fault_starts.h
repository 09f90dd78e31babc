// Where the fit of each fault begins. Every starting severity is run once with all else where the origin has it, and
// judged by what the origin's linear model could still make of it; the starts that come best are kept.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/fit_steps.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "diagnose/visible.h"
#include "faults/fault.h"

namespace servodx {

// What a fault's other numbers begin at: health as it was fitted, or as the table has it.
struct Origin {
  HypothesisFit fit;
  std::optional<FitEnd> end;  // none where that fit failed
};

// Every starting severity of every fault, the best first.
std::vector<Screened> screen_starts(const std::vector<const Fault*>& faults, const HypothesisData& data,
                                    const Origin& origin, FitSteps& steps);

// Of each fault the starts that screened best: one, and those that the linear model does not put hopelessly behind it.
std::vector<Attempt> best_starts(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened,
                                 const HypothesisFit& health, const HypothesisData& data);
// Each side of each fault, the failure modes that sub-groups are made of, beginning where it screened best.
std::vector<Attempt> starts_of_sides(const std::vector<const Fault*>& faults, const std::vector<Screened>& screened);

// What the screened severities would have gained, the mildest first; of a fault with two sides each by itself.
std::vector<VisibleFault> screened_gains(const std::vector<const Fault*>& faults,
                                         const std::vector<Screened>& screened);

}  // namespace servodx
