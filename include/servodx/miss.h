// What a tune does not follow, and what stands first of what explains it.
#pragma once
#include <optional>
#include <vector>

#include "servodx/diagnose.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/tune.h"

namespace servodx {

// By explain() of the log that the tune follows worst. None where it follows every channel of its logs, of a table that
// was read, and where the call was stopped. `logs`: those of the tune, in its order.
std::optional<Verdict::Beyond> likeliest_miss(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                                              const ExplainOptions& options = {});

}  // namespace servodx
