// What `trend` says of each valve's life, as text for Prometheus: servodx_valve_state (1 for the state the valve is in)
// and servodx_valve_life_left_hours by `bound`.
#pragma once
#include <string>
#include <vector>

#include "servodx/trend.h"

namespace servodx::report {

std::string life_gauges(const std::vector<Trend>& trends);

}  // namespace servodx::report
