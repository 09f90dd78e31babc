// Where a log starts: what its channels measured first, and how fast the piston went. The simulation settles there
// (simulate/initial_state.h); what the noise of these samples is off by is a nuisance (start_values).
//
// The speed is the least-squares slope of the first 10 ms; fewer than three samples there, and it is taken as nought.
#pragma once
#include <vector>

#include "fit/log_data.h"

namespace servodx {

// Has the simulation start where the channels were measured first.
void take_start(LogData& log);

// Standard error of the starting speed over that of one sample. [1/s]
double starting_slope_error(const std::vector<double>& time);

}  // namespace servodx
