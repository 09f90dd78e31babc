// Forward selection of causes, one a round, and leaving each out again. The rules are in forward_rules.h; here they are
// given what they ask for.
#pragma once
#include <vector>

#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/subject.h"

namespace servodx {

// What has been accepted so far.
struct Selected {
  ExplainedFit fit;      // with the causes
  ExplainedFit retuned;  // the same on top of re-tuning; not ok: re-tuning is not asked
  std::vector<CauseResult> causes;
  int rounds = 0;  // in which a cause was accepted
};

// BIC on independent samples: positive where what `after` has beyond `before` is worth its numbers.
double delta_bic(const ExplainedFit& before, const ExplainedFit& after, double degrees);

// One round: at most one more cause. False: none, and no further round. Fates, standing and refused names go to `out`.
bool accept_one_more(const Subject& subject, const EngineOptions& options, bool begun, Selected& so_far,
                     FoundCauses& out);
// Leaves each out again, the last one excepted: it has just shown its worth beside the others.
void leave_out_again(const Subject& subject, const EngineOptions& options, Selected& so_far, FoundCauses& out);

}  // namespace servodx
