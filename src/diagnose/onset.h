// Since when: one change in a log, healthy before it and faulty after it.
//
// The squared residual under health is searched for one change of variance (binary segmentation of a normal likelihood;
// Killick & Eckley 2014). Where one stands out, both parts are fitted apart. A fault that grows slowly shows no change.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "diagnose/hypotheses.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {

// The sample at which the variance of a series of squares steps up; `independent` of its samples count.
std::optional<std::size_t> variance_step_up(const std::vector<double>& square, double independent);

struct SplitGains {
  double whole = 0;   // misfit of the log under its best hypothesis
  double split = 0;   // misfit of both parts: healthy before, best hypothesis after
  double before = 0;  // gain of the fault over health in the part before
  double after = 0;   // and in the part after
};
// Whether the split pays for a second set of nuisances and a time, and the fault is of the part after.
bool is_onset(const SplitGains& gains, double independent);

struct Onset {
  std::size_t at = 0;  // first sample of the fault
  HypothesisFit healthy_before;
  HypothesisFits after;
};

// `whole`: the hypotheses fitted to all of the log. Counts the work of every part that was fitted.
std::optional<Onset> find_onset(const LogData& log, const ParameterVector& base, const ErrorModel& error,
                                const HypothesisSettings& settings, const HypothesisFits& whole, FitWork& work);

// Whether a log is long enough for its parts to be fitted.
bool onset_possible(const LogData& log);

}  // namespace servodx
