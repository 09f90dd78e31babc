// The fit of health: from several starts, again from where the faults ended, and to a part of a log alone.
//
// Every gain of a fault is over this fit: a poor valley of health lends each of them one.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "diagnose/fit_steps.h"
#include "diagnose/hypotheses.h"
#include "diagnose/hypothesis_fit.h"
#include "fit/error_model.h"
#include "fit/fit_work.h"
#include "fit/log_data.h"
#include "simulate/scenario.h"

namespace servodx {

struct HealthFit {
  Attempt attempt;
  std::optional<FitEnd> end;  // none where the fit failed
};

// From its usual start, then from others around it.
HealthFit fit_health(const HypothesisData& data, FitSteps& steps);

// Health had few starts, the faults many: what one of them gained by better nuisances is no fault's. So health begins
// again where each fault ended, and where the best one did by derivatives of its own: its gain decides.
void begin_health_again(HealthFit& health, const std::vector<Attempt>& faults, const HypothesisData& data,
                        FitSteps& steps);

// Whitened rms of the worst channel under health, fitted to the log; none where the fit fails. `name`: of the stage.
std::optional<double> healthy_adequacy(const LogData& log, const std::string& name, const ParameterVector& base,
                                       const ErrorModel& error, const HypothesisSettings& settings, FitWork& work);

// The log's squared residual, a sample, under health as fitted to its beginning alone, the samples before `end`: what a
// whole log's fit cannot show where a fault that steps in drags the nuisances along. Empty where the fit fails.
std::vector<double> square_beyond_beginning(const LogData& log, std::size_t end, const ParameterVector& base,
                                            const ErrorModel& error, const HypothesisSettings& settings, FitWork& work);

}  // namespace servodx
