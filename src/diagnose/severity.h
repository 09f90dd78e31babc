// What each hypothesis leaves free: a fault's severity, the tolerances of the others, the log's nuisances.
//
// A severity runs from the mildest that is called the fault to the worst, on the side of its start. Health, and every
// fault beside its own severity, lets each fault's severity wander within its tolerance, with a prior.
#pragma once
#include <vector>

#include "faults/fault.h"
#include "faults/sizes.h"
#include "fit/chart.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "simulate/scenario.h"

namespace servodx {

struct FaultStart {
  const Fault* fault = nullptr;  // null: left out
  double severity = 0;           // its sign chooses the side
};
// The faults' severities first. Shared by the logs but for each log's nuisances.
std::vector<FreeValue> hypothesis_values(const std::vector<const LogData*>& logs, const ParameterVector& base,
                                         const std::vector<FaultStart>& faults, double null_limit,
                                         const TimesDrawing& times_drawing = {});

// Severities to begin at.
std::vector<double> starting_severities(const Fault& fault, const ParameterVector& base, double null_limit,
                                        const TimesDrawing& times_drawing = {});

}  // namespace servodx
