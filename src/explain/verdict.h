// The rules that end an explanation: evidence in, verdict out. No fit, no log.
#pragma once
#include <cstddef>

#include "explain/outcome.h"

namespace servodx {

struct EndEvidence {
  bool compared = false;      // with healthy logs; else the next two mean nothing
  double level = 0;           // false-alarm rate asked for
  double chance_left = 1;     // chance that healthy logs are left with as much
  std::size_t causes = 0;     // taken
  double share_of_first = 0;  // of the held-out misfit, that the first removes by itself
  bool curve = false;         // one of them is a learnt curve
  bool told_by_blocks = false;
  bool told_of_drive = false;  // a cause ahead of the simulation, which says nothing of it
  double over_noise = 0;       // held-out rms over the sensor's noise, of the worst of spool and pressures
  double block_misses = 0;     // of what passes through the block that misses most, the part that it misses
};

// Left abnormal by names of which the first removes less than half of it: most of what is wrong has no name, and a heap
// of names is none.
bool has_no_name(const EndEvidence& evidence);
// Without healthy logs to compare with: no cause was taken, the simulation is far from the sensors' noise, and a block
// with measured signals around it misses a good part of what passes.
bool misses_without_name(const EndEvidence& evidence);
ExplainVerdict verdict_of(const EndEvidence& evidence);

}  // namespace servodx
