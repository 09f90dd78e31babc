// Notes on values that can be read but hardly believed: no excitation, a frozen sensor, spikes, a likely wrong unit,
// gaps in time. Nothing is changed; the limits are constants stated in the .cpp, loose on purpose.
#pragma once
#include <string>
#include <vector>

#include "signals/log.h"

namespace servodx {

std::vector<std::string> implausible_values(const Log& log, const RigFile& rig);

}  // namespace servodx
