// What fits of hypotheses come to, as an assessment holds it: misfit and gain of each, size and rows, second faults
// beside a first, what was visible, and what each says the log should be. Of fits that are done; nothing is run.
#pragma once
#include <optional>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/hypotheses.h"
#include "diagnose/onset.h"
#include "diagnose/ready_logs.h"
#include "diagnose/visible.h"
#include "parameters/table.h"
#include "servodx/tune.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

// In the order of the fits. `base`: the tuned candidate.
std::vector<HypothesisResult> hypothesis_results(const HypothesisFits& fits, const ParameterVector& base,
                                                 const Table& tuned);
// The best first; of a pair the fault that fits better alone.
std::vector<PairResult> pair_results(const HypothesisFits& fits);
// As gains of hypotheses are: beside what the model errs by.
std::vector<VisibleFault> visible_beside_error(const HypothesisFits& fits);
// What tempers the probabilities of these hypotheses (evidence/probabilities.h).
double scale_of_misfits(const HypothesisFits& fits);
// Of a log with an onset, health speaks of the part before and the faults of the part after.
std::vector<HypothesisPrediction> predictions_of(const ParameterVector& base, const HypothesisFits& fits,
                                                 const std::optional<Onset>& onset);
// What health leaves of each channel, beside its noise; of several logs a channel's squares are pooled.
std::vector<ChannelResult> channels_under(const HypothesisFit& healthy, const std::vector<Log>& logs,
                                          const ReadyLogs& ready);

}  // namespace servodx
