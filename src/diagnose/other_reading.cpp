#include "diagnose/other_reading.h"

#include <algorithm>

#include "diagnose/constants.h"
#include "diagnose/health_fit.h"
#include "diagnose/judgeable.h"
#include "fit/error_model.h"
#include "fit/fast_log.h"
#include "fit/log_data.h"
#include "fit/tuned_state.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

const HypothesisResult& best_of(const std::vector<HypothesisResult>& hypotheses) {
  return *std::min_element(hypotheses.begin(), hypotheses.end(),
                           [](const auto& x, const auto& y) { return x.misfit < y.misfit; });
}

// Where little of the motion is left as it was read, that is the model's own error too, and the motion alone tells no
// reading from a fault: a slow log at twice its time moves nearly as it did. A reading then has to make a healthy log
// of it: health, fitted, is by far less wrong than the best hypothesis is of the log as it was read.
bool makes_a_healthy_log(const Reading& reading, const Log& log, const ParameterVector& base, const ReadingTrial& trial,
                         const HypothesisSettings& settings, const HypothesisResult& as_read, FitWork& work) {
  if (!(reading.left < k::misread_beside * as_read.motion_left)) return false;
  LogData data = prepare_at_points(read_as(log, reading), trial.rig, recorder_of(trial.tuned));
  leave_out_unknown_channels(data, trial.error);
  const auto adequacy = healthy_adequacy(data, "read otherwise", base, trial.error, settings, work);
  return adequacy && *adequacy < k::misread_beside * as_read.adequacy;
}

}  // namespace

std::optional<Reading> other_reading(const Log& log, const ParameterVector& base, const ReadingTrial& trial,
                                     const HypothesisSettings& settings, const std::vector<HypothesisResult>& as_read,
                                     FitWork& work) {
  const HypothesisResult& best = best_of(as_read);
  const bool much = best.motion_left > k::worth_reading;
  const bool told = best.adequacy <= k::told_as_it_is || as_read.front().adequacy <= k::fault_allowance;
  if (!much && told) return {};
  std::optional<Reading> reading = best_reading(log, Unjudgeable::no, trial);
  if (!much && reading && !makes_a_healthy_log(*reading, log, base, trial, settings, best, work)) return {};
  return reading;
}

}  // namespace servodx
