// Notes on values that can be read but hardly believed: no excitation, a frozen sensor, spikes, a likely wrong unit,
// gaps in time. Nothing is changed; the limits are constants stated in the .cpp, loose on purpose.
#pragma once
#include <array>
#include <vector>

#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "signals/one_pass.h"

namespace servodx {

// `sweeps`: of the log's signals, in the order of signal_list.
std::vector<Note> implausible_values(const Log& log, const RigFile& rig, const std::array<Sweep, n_signals>& sweeps);

}  // namespace servodx
