// What a test asks of a rig, tick by tick of its generator or controller. Amplitudes and times are fitted to the rig,
// so that the piston stays off its stops and the loop follows.
#pragma once
#include <string>
#include <vector>

#include "base/random.h"
#include "design.h"

namespace servodx::foreign {

enum class Trial {
  steps_large,
  steps_small,
  sine,
  multisine,
  prbs,
  prbs_jittered,
  sweep,
  triangle,
  flight,
  flight_dropped,
  slow_track,
  acceptance,
  mixed
};

struct Excitation {
  std::string name;
  double duration;                 // [s]
  bool closed = false;             // demand is a position [m], else a fraction of the rated current
  std::vector<double> demand;      // one a tick
  double spring = 0.0;             // [N/m] external load
  double drag = 0.0;               // [N s/m]
  std::vector<double> turbulence;  // [N] one a tick, or empty
  bool jittered = false;           // time stamps are uneven
  bool dropped = false;            // samples are missing
};

// Of the acceptance test every call gives the same demand for one design.
Excitation make_excitation(const Design& design, Trial test, Random random);

}  // namespace servodx::foreign
