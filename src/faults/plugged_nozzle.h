// Plugged nozzle: the pilot bridge is out of balance. A mild one looks like a shifted null; the slew differs by
// direction. Two nozzles are never quite alike: up to `least` it is a tolerance. Positive severity: nozzle 1, which
// drives the spool positive when it is closed; negative: nozzle 2.
#pragma once
#include <algorithm>

#include "effects/nozzle_plugging.h"
#include "effects/registry.h"
#include "faults/fault.h"

namespace servodx {

inline const Fault plugged_nozzle{
    .name = "plugged_nozzle",
    .meaning = "one nozzle of the first stage is partly blocked",
    .unit = "blocked fraction of one nozzle, negative for nozzle 2",
    .healthy = 0.0,
    .worst = 0.98,
    .log_scale = false,
    .prior = 0.1,
    .least = 0.1,
    .spread = 0.15,  // traded against the null
    .starts = {0.15, 0.7, -0.15, -0.7},
    .test = "full steps both ways: the slew differs by direction, where a shifted null moves both alike",
    .action = "critical: stop the machine",
    .apply =
        [](double* v, double s) {
          v[effect_row<NozzlePlugging>(0)] = std::max(0.0, s);
          v[effect_row<NozzlePlugging>(1)] = std::max(0.0, -s);
        },
    .ends_whole = true};

}  // namespace servodx
