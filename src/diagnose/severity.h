// What each hypothesis leaves free: a fault's severity, the tolerances of the others, the log's nuisances.
//
// A severity runs from the mildest that is called the fault to the worst, on the side of its start. Health, and every
// fault beside its own severity, lets each fault's severity wander within its tolerance, with a prior.
#pragma once
#include <vector>

#include "faults/fault.h"
#include "fit/problem.h"

namespace servodx {

// The severity first, where there is a fault. `start`: of the severity; its sign chooses the side.
std::vector<FreeValue> hypothesis_values(const LogData& log, const ParameterVector& base, const Fault* fault,
                                         double start, double null_limit);

// Severities to begin at.
std::vector<double> starting_severities(const Fault& fault, double null_limit);

}  // namespace servodx
