// Which failure begins here: a name within milliseconds, before there is enough to fit.
//
// Every fault of the list, at a few severities, is run from the last healthy sample on; the one whose run lies nearest
// the log is named. Its severity is not told: the diagnosis of the window does that. A driver that does not pass on the
// command is told by its record, a spool that rests while the command moves by itself.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "faults/gross_finding.h"
#include "online/watched_model.h"
#include "servodx/log.h"
#include "signals/sample.h"

namespace servodx {

struct NameScore {
  std::string name;   // label of a fault; empty: healthy
  double misfit = 0;  // sum of squared deviates
  double severity = 0;
};

struct SuddenEvidence {
  std::vector<NameScore> scores;  // each fault's best, the nearest first; healthy among them
  bool driver = false;            // the alarm is the driver's record
  bool supply = false;            // the alarm is the supply's record
  GrossFinding gross = GrossFinding::none;
  std::size_t samples = 0;
};

// Empty: nothing explains the samples well enough. Pure.
std::string name_of(const SuddenEvidence& evidence);

// `samples`: from the last healthy one on.
std::vector<NameScore> score_failures(const WatchedModel& model, std::span<const Sample> samples,
                                      const std::vector<Signal>& channels);

// What a spool shows without a model (diagnose/gross.h), in the last samples.
GrossFinding gross_finding_in(const WatchedModel& model, std::span<const Sample> samples);

}  // namespace servodx
