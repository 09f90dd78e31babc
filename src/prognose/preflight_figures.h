// r and E(tau) of a preflight test, from the spool and piston that a log measured or that a run of the model showed.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "fit/log_data.h"
#include "prognose/checks.h"
#include "prognose/preflight.h"
#include "servodx/log.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {

struct Traces {
  const std::vector<double>* spool = nullptr;  // null: none
  const std::vector<double>* piston = nullptr;
  double spool_noise = 0, piston_noise = 0;
};
struct PreflightFigures {
  std::optional<Fidelity> fidelity;
  std::vector<std::optional<Figure>> correlation;  // one a sine
};

// The channel of a signal; null where the log has none.
const FitChannel* channel_of(const LogData& log, Signal signal);
Traces measured_traces(const LogData& log);
Traces traces_of(const Trajectory& run, const LogData& log);
// Of a spool its mean at rest, the offset, is taken off first. `monitor_spool`: the monitor's, from rest.
PreflightFigures figures_of(const std::vector<double>& time, const Preflight& test, const Traces& traces,
                            const std::vector<double>& monitor_spool);
// Of the first `n` samples that are not missing; 0 where all are.
double mean_of_first(const std::vector<double>& x, std::size_t n);

}  // namespace servodx
