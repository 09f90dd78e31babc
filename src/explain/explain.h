// `explain`: what the simulation gets wrong on these logs, where, why, and what mending it gains. docs/explain.md.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "evidence/heldout_gain.h"
#include "explain/blocks.h"
#include "explain/engine.h"
#include "explain/healthy.h"
#include "explain/learnt_curves.h"
#include "explain/missing.h"
#include "explain/outcome.h"
#include "explain/show.h"
#include "parameters/table.h"
#include "servodx/explain.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

struct ExplainedChannel {
  std::string signal, unit;  // unit as in the first log that has it
  double rms_before = 0, rms_after = 0, noise_rms = 0, heldout_before = 0, heldout_after = 0;  // [SI]
  std::optional<Signal> id = {};                                                               // that `signal` names
};
struct ExplainedParameter {
  std::string name, unit;
  double value = 0, std_error = 0, before = 0;  // [unit]
  double lower = 0, upper = 0;                  // [unit] 90 %, within what is physical; NaN at a bound
  SizeTold told = SizeTold::interval;
};
struct ExplainedCause {
  std::string effect, where, test;
  std::vector<ExplainedParameter> parameters;
  Interval heldout_gain, beyond_retuning;
  double delta_bic = 0;
  std::vector<std::string> confusable_with;
  ToldBy told_by = ToldBy::simulation;
  bool curve = false;        // learnt: its numbers are the knots
  bool of_sensor = false;    // it is the sensor's that recorded a channel
  std::string meaning = {};  // as the lists of effects and of rows say it; empty where they do not
};
struct ExplainedCandidate {
  std::string effect, where;
  Fate fate = Fate::not_looked_at;
  double predicted_gain = 0;
  std::optional<double> p_new;
  bool fitted = false;
  Interval heldout_gain, share;
  double delta_bic = 0;
};

// What something missing at a place, a function of one variable there, would remove of the misfit. Scored where nothing
// that has a name suffices.
struct PlaceScore {
  std::string where, variable;
  double gain = 0;
  std::optional<double> p_new;
};

// What stands first in logs that cannot be told from healthy ones.
struct ExplainSuspicion {
  std::string effect, where;
  std::optional<ExplainedParameter> size;  // its first number
  Interval share;                          // of the held-out misfit of what it speaks of
  double rate = 1;                         // of false alarms at which it would be said, by the tail's law
  int logs = 0, logs_needed = 0;           // healthy ones; until it would be said at the rate they can promise; 0, -1:
                                           // no number does
  bool of_sensor = false;                  // the share is of its channel's misfit alone
};
struct ExplainedProbability {
  std::string cause;
  double value = 0;
};
struct ExplainedProbabilities {  // evidence/posterior.h
  std::vector<ExplainedProbability> causes;
  double unlisted = 0, nothing = 1;
};

// How often a healthy log is called wrong: asked for, and what so many healthy logs can promise. Of a test that none of
// them is of, the rate is an assumption.
struct ExplainedFalseAlarm {
  double asked = 0, promised = 0;
  int logs = 0;
  bool alike = true;
};

struct ExplainResult {
  std::optional<LearntCurve> curve;  // of `unexplained`
  ExplainVerdict verdict = ExplainVerdict::sufficient;
  std::string where;       // of the first cause; empty: nowhere
  std::string depends_on;  // of `unexplained`: the variable that it follows, "X by Y" where it takes two
  std::vector<ExplainedChannel> channels;
  std::vector<ShownChannel> shown;  // the residual as tuned
  std::vector<BlockReplay> blocks;  // what each block misses with measured signals in place of simulated ones
  std::vector<PlaceScore> places;   // the best that a curve could do at each place, first the most
  MissingInputs missing;            // as tuned, what is missing over time, were it all at one place
  std::vector<ExplainedCause> causes, standing;
  std::vector<ExplainedCandidate> candidates;
  std::optional<ExplainedFalseAlarm> false_alarm;       // where healthy logs are there to compare with
  std::optional<ExplainSuspicion> suspicion;            // of a sufficient simulation
  std::optional<ExplainedProbabilities> probabilities;  // where healthy logs are there to compare with
  bool worse_withheld = false;                          // the table is as tuned: the extension's held-out rms is worse
  Interval retuned;                                     // held-out gain of re-tuning alone
  Interval heldout_gain;                                // of all causes together over re-tuning alone
  double adequacy_before = 0, adequacy_after = 0;       // misfit over independent samples
  std::optional<double> p_adequacy;                     // chance that a healthy log is left with as much, after
  Table table;                                          // extended
  std::vector<ParameterVector> before, after;           // candidates of each log, as tuned and with the causes
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
};

// `healthy` may be null: then of everything.
ExplainResult explain_logs(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                           const HealthyReference* healthy, const ExplainOptions& options);

}  // namespace servodx
