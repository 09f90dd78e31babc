// Of each fault what the log that shows it best would show of it.
#pragma once
#include <vector>

#include "servodx/check_log.h"

namespace servodx {

// In the order of the promises' faults; empty without a promise. A fault whose every simulation failed has 0 deviates.
std::vector<Visible> best_seen(const std::vector<Promise>& promises);

}  // namespace servodx
