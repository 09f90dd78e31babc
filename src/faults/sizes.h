// The sizes of a fault on one valve: those that it states, or as many times as it gives for that valve.
#pragma once
#include <algorithm>
#include <map>
#include <vector>

#include "faults/fault.h"

namespace servodx {

struct FaultSizes {
  double least, worst, spread;  // in the severity's unit; spread as the fault states it
  std::vector<double> starts;
};

// Of a fault whose size counts in a row: that row of the valve over its drawing's.
using TimesDrawing = std::map<const Fault*, double>;

// `candidate`: the healthy valve's rows. [SI] A row below its drawing's gave way to something that the model lacks: the
// fault's size may be as many times larger, so the worst is that of the drawing's row.
inline FaultSizes sizes_of(const Fault& fault, const double* candidate, const TimesDrawing& times_drawing = {}) {
  const double times = fault.times ? fault.times(candidate) : 1;
  FaultSizes out{times * fault.least, times * fault.worst, times * fault.spread, fault.starts};
  for (double& start : out.starts) start *= times;
  if (const auto off = times_drawing.find(&fault); off != times_drawing.end()) out.worst /= std::min(1.0, off->second);
  return out;
}

}  // namespace servodx
