// Whether what the hypotheses leave of a log asks for another reading of it (reading.h), and which one mends it.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/hypotheses.h"
#include "diagnose/reading.h"
#include "fit/fit_work.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {

// Where the best fit leaves much of the motion, or health fits worse than a fault may: was the log read wrongly? A log
// that its best fit leaves as tuning logs are left asks for no other reading. `as_read`: health first, with what each
// leaves of the motion. `base`: the tuned candidate. Counts the work of a fit.
std::optional<Reading> other_reading(const Log& log, const ParameterVector& base, const ReadingTrial& trial,
                                     const HypothesisSettings& settings, const std::vector<HypothesisResult>& as_read,
                                     FitWork& work);

}  // namespace servodx
