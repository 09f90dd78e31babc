// What may be wrong of a sensor, a flow meter or the command's line: pick-up of the mains, gain and lag. One cause a
// channel, and none of a sensor that no log compares.
#pragma once
#include <vector>

#include "effects/registry.h"
#include "explain/sought_cause.h"
#include "explain/valve_causes.h"

namespace servodx {

std::vector<SoughtCause> mains_causes(const EffectInfo& pickup, const CauseFacts& facts);
std::vector<SoughtCause> sensor_causes(const EffectInfo& response, const CauseFacts& facts);
std::vector<SoughtCause> flow_meter_causes(const EffectInfo& lag, const CauseFacts& facts);

}  // namespace servodx
