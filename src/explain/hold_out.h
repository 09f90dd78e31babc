// Held-out misfit of a fit: blocks of time are left out in turn, and what the free run over a block misses by a fit
// that had not seen it is summed.
//
// Every log is cut into pieces of about the same length, which all its channels share. Without its blocks a minimum
// moves a little: one Gauss-Newton step on the box finds it. That holds where a fold is a small part of the data; a
// cause that shows in one block alone is found too good.
#pragma once
#include <cstdint>
#include <vector>

#include "evidence/heldout_gain.h"
#include "explain/fit_causes.h"
#include "explain/subject.h"

namespace servodx {

struct Folds {
  int folds, blocks;  // blocks over all logs together; a fold leaves out every `folds`-th
};

// Fills heldout and heldout_residual.
void cross_validate(const Subject& subject, ExplainedFit& fit, const Folds& folds);
// Fraction of `before`'s held-out misfit that `after` removes, with its block-bootstrap interval (90 %).
Interval heldout_gain(const ExplainedFit& before, const ExplainedFit& after, std::uint64_t seed);
// The same of what a cause speaks of: a sensor's fault of its own channel, any other cause of all.
Interval heldout_share(const Subject& subject, const Cause& cause, const ExplainedFit& before,
                       const ExplainedFit& after, std::uint64_t seed);

}  // namespace servodx
