// A log beside what candidates say it should have been: the material of every trace and residual plot.
//
// Costs one simulation a candidate. Residuals are filtered as the fit's are (the piston's slow drift is left out), and
// the band is the sigma(t) of fit/error_model.h: sensor noise and what the model is known to err by.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "fit/error_model.h"
#include "servodx/log.h"
#include "servodx/replay.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "simulate/scenario.h"

namespace servodx {

struct Candidate {
  std::string name;  // "healthy", a fault's label, "tuned"
  ParameterVector candidate;
  std::size_t from = 0;  // first sample it speaks of: a fault that steps in explains what follows
};

// The log prepared as the table says it was tuned.
Replay replay(const Log& log, const Table& tuned, const RigFile& rig, const std::vector<Candidate>& explanations);

}  // namespace servodx
