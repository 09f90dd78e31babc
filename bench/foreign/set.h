// The logs that a rig comes with: fault-free ones of a dozen tests, repeats of one acceptance test, faults, faults that
// step in, and hidden effects; each with the row of truth.csv that says what it is.
#pragma once
#include <string>
#include <vector>

#include "design.h"
#include "run.h"

namespace servodx::foreign {

struct Truth {
  std::string path, set, kind, severity;
  double severity_value = 0.0;
  bool with_value = false;
  std::string effect;
  double onset = -1.0;  // [s] negative: none
  std::string size;     // of an effect: full, third; of a broken sensor its channel
};

struct Planned {
  Truth truth;
  Job job;
};

struct Wanted {
  bool healthy = true, fault = true, hidden = true, pair = true;  // pair: driver and sensors too
  bool assorted = true, acceptance = true;
};

std::vector<Planned> plan(const Design& design, const Wanted& wanted);

}  // namespace servodx::foreign
