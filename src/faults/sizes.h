// The sizes of a fault on one valve: those that it states, or as many times as it gives for that valve.
#pragma once
#include <vector>

#include "faults/fault.h"

namespace servodx {

struct FaultSizes {
  double least, worst, spread;  // in the severity's unit; spread as the fault states it
  std::vector<double> starts;
};

// `candidate`: the healthy valve's rows. [SI]
inline FaultSizes sizes_of(const Fault& fault, const double* candidate) {
  const double times = fault.times ? fault.times(candidate) : 1;
  FaultSizes out{times * fault.least, times * fault.worst, times * fault.spread, fault.starts};
  for (double& start : out.starts) start *= times;
  return out;
}

}  // namespace servodx
