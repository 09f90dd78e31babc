// What a score test says of one cause (score.h).
#pragma once
#include <vector>

namespace servodx {

// Of one probe of a cause: its size in units of the probe, with what the free numbers cannot imitate.
struct ProbeScore {
  double size = 0, std_error = 0;  // [of the probe]
};
struct CauseScore {
  int cause = 0;
  double gain = 0;                 // predicted fall of the deviance
  int alternative = 0;             // of its probes
  std::vector<ProbeScore> probes;  // all of them, alternatives one after another
  double of = 1;                   // what it is a factor on: mean of the base's numbers that it is atop of
};

}  // namespace servodx
