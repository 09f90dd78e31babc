// A log beside what candidates say it should have been: the material of every trace and residual plot.
//
// Costs one simulation a candidate. Residuals are filtered as the fit's are (the piston's slow drift is left out), and
// the band is the sigma(t) of fit/error_model.h: sensor noise and what the model is known to err by.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "fit/error_model.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

struct Candidate {
  std::string name;  // "healthy", a fault's label, "tuned"
  ParameterVector candidate;
  std::size_t from = 0;  // first sample it speaks of: a fault that steps in explains what follows
};

struct ReplayedChannel {
  Signal signal;
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

// The log prepared as the table says it was tuned.
Replay replay(const Log& log, const Table& tuned, const RigFile& rig, const std::vector<Candidate>& explanations);

}  // namespace servodx
