// Logs that no fit can learn from are refused before the first one.
#pragma once
#include <fmt/format.h>

#include <vector>

#include "diagnose/constants.h"
#include "fit/log_data.h"
#include "fit/ports_of.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx::door {

// Throws InputError where rows come more slowly than a valve answers; a test stand may be read point by point.
inline void require_samples(const std::vector<Log>& logs, const Rig& rig) {
  for (const Log& log : logs) {
    if (log.samples() < 2 || ports_of(log, rig) != Ports::actuator) continue;
    const double step = (log.time.back() - log.time.front()) / static_cast<double>(log.samples() - 1);
    if (step <= diagnose_constants::slowest_step) continue;
    throw InputError(
        {.file = log.path, .column = "time"},
        fmt::format("{:.4g} samples a second are too few to see a valve move, and nothing is fitted", 1 / step),
        "look at the unit of time (is it in ms, and read as s?), or record at 200 Hz or more");
  }
}

}  // namespace servodx::door
