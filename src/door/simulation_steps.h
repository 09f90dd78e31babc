// The steps of a simulation that is looked at sample by sample.
#pragma once
#include "servodx/simulate.h"
#include "simulate/scenario.h"

namespace servodx::door {

// `wanted` is left as it is.
SimulateOptions steps_of(const SimulationOptions& options);

}  // namespace servodx::door
