// Company of a task that runs beside others (simulate/together.h): what it would have run is asked for there, and run
// with what the others ask for.
#pragma once
#include <span>

#include "base/meeting.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

struct RunRequest {
  std::span<const Job> jobs;
  SimulateOptions options;
};

// Of the task that runs in this thread; null for one that is alone.
const Meeting<RunRequest>::Ask* company();

}  // namespace servodx
