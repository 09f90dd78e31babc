// Whether a measured load pushes the way that the pressures say.
//
// Friction and mass apart, the chambers hold the load: A_A p_A - A_B p_B = F. Where the load moves them much, both rise
// and fall together, and a load cell with its sign turned runs against them. So do two chambers that are exchanged:
// what the flow into them says decides (flow_into_chambers.h).
//
// Leaves out: logs in which friction and mass move the pressures as far as the load; a gain that is wrong.
#pragma once
#include <optional>

#include "servodx/check_log.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {

// `rate`: samples a second. None where nothing is wrong, or nothing can be said.
std::optional<Finding> load_against_pressures(const Log& log, const RigFile& rig, double rate);

}  // namespace servodx
