// A table as a candidate of the simulation.
#pragma once
#include "parameters/table.h"
#include "simulate/scenario.h"

namespace servodx {

// The table's nominal values: effects without a row at their off value, nuisances at zero.
ParameterVector candidate_of(const Table& table);

}  // namespace servodx
