// A log beside what explanations of it say that it should have been, sample by sample. `servodx/pages.h` makes them.
#pragma once
#include <string>
#include <vector>

#include "servodx/log.h"

namespace servodx {

struct ReplayedChannel {
  Signal signal = Signal::time;
  std::string unit;              // as in the log
  std::vector<double> measured;  // [SI] NaN where missing
  std::vector<double> sigma;     // [SI] of the residual of the first explanation
  struct Simulated {
    std::string name;
    std::vector<double> value;     // [SI] NaN before its first sample
    std::vector<double> residual;  // [SI] measured less simulated, filtered
  };
  std::vector<Simulated> simulated;  // an explanation whose simulation failed is left out
};

struct Replay {
  std::string log;
  std::vector<double> time;     // [s]
  std::vector<double> command;  // [A] what drove the simulation
  bool current_measured = false;
  std::vector<ReplayedChannel> channels;
};

}  // namespace servodx
