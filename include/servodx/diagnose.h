// Diagnose: is a log like the fault-free ones, and if not, which fault, how large, since when. docs/diagnosis.md.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/actions.h"
#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {

struct Diagnosis;  // the library's own

// How a fault's fit finds where to begin: the severities that screen best, approached by the derivatives of health; or
// a genetic search over sub-groups, one a failure mode (GA paper). The local refinement behind either is the same.
enum class FaultSearch { by_fault, genetic };

struct DiagnoseOptions {
  std::uint64_t seed = 1;
  int threads = 0;                      // 0: all cores; the result does not depend on it
  Watch watch = {};                     // stopped: what comes back says `interrupted` and nothing else
  Actions actions = default_actions();  // by label
  FaultSearch search = FaultSearch::by_fault;
  int population = 50;          // of each sub-group of a genetic search
  bool explain_unknown = true;  // ask `explain` what stands first where no fault explains the log

  // Throws InputError naming the option.
  void validate() const;
};

struct Verdict {
  enum class Kind { healthy, fault, unknown };
  struct Severity {
    double value = 0, lower = 0, upper = 0;  // [unit] 95 %
    std::string unit;
  };
  // What stands first in a log that cannot be told from healthy ones.
  struct Suspicion {
    std::string name;
    Severity severity;
    double rate = 1;      // of false alarms at which it would be said
    int logs_needed = 0;  // healthy ones, until it would be said; 0: more do not help by themselves, -1: no number does
  };
  struct Named {
    std::string name;
    double probability = 0;
    Severity severity;    // not a number: it has no size
    std::string channel;  // of a sensor's: which signal; else empty
  };
  // The least severity of a fault that would not have passed as healthy in 95 of 100 such logs.
  struct Detectable {
    std::optional<double> value;  // [unit] none: this log would not have shown the worst of it
    std::string unit;
  };
  // What `explain` finds where no fault explains the log.
  struct Beyond {
    std::string first, where, depends_on;  // effect; place; of a curve without a name the variable it follows
    double share = 0;                      // of the held-out misfit that it removes
    bool taken = false;                    // beyond what healthy logs show
    bool outside = false;                  // of a sensor, or between command and coil: nothing of the valve
  };
  // Of a spool, beside what leakage can press one of its lands onto the sleeve with (Merritt 1967).
  struct Friction {
    double friction = 0;  // [N] of the spool, sliding and breaking away
    double largest = 0;   // [N] lateral, of one land
    // That the largest force would need to bring this friction.
    double coefficient() const { return friction / largest; }
  };
  std::string log;
  bool interrupted = false;
  Kind kind = Kind::healthy;
  double error = 0, threshold = 0;               // [deviates] from health; beyond the threshold it is not healthy
  double p_value = 1;                            // of such an error on a healthy log
  std::string fault;                             // label of the one named; empty: none
  std::vector<Named> faults;                     // none, one, or two; the first is the one named
  std::optional<Severity> severity;              // of the fault named
  std::map<std::string, double> probabilities;   // by label; "healthy" and "unknown" among them
  std::vector<std::string> ambiguous_with;       // labels that cannot be ruled out beside the fault named
  std::string separating_test;                   // input that would separate them; empty: none is needed
  std::optional<double> onset;                   // [s] since when, where a change in mid-log stands out
  std::optional<Suspicion> suspicion;            // of a healthy verdict
  std::map<std::string, Detectable> detectable;  // what this log could have shown, by label
  std::optional<Beyond> beyond;                  // of an unknown verdict
  std::optional<Friction> friction;              // of a named fault that moves the spool's, where the rig file states
                                                 // the land's length
  ActionClass action_class = ActionClass::none;
  std::string action;                       // what the fault named asks for
  std::vector<ParameterResult> parameters;  // rows that moved, the fault's first
  std::vector<ChannelResult> channels;      // replay under health: rms beside noise
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  std::shared_ptr<const Diagnosis> whole;  // for the program's pages
};

// "healthy", "fault" or "unknown".
std::string name_of(Verdict::Kind kind);
// As it stands among the `results` of `servodx diagnose --json`; "null" of an interrupted one.
std::string json_of(const Verdict& verdict);

// All refuse a baseline of another table, and a log without a signal that the model reports.
// Throws InputError. Several logs of one valve in one state: one verdict for all of them. At least one log.
Verdict diagnose_pool(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                      const DiagnoseOptions& options = {});
Verdict diagnose(const Log& log, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                 const DiagnoseOptions& options = {});
// Of a piece of a log that goes on: the verdict alone. No `explain`, no action, no friction beside the lateral force,
// no operating point beside the tuning logs'.
Verdict diagnose_window(const Log& window, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                        const DiagnoseOptions& options = {});
// Each log by itself, side by side, in their order; of those that were judged before the call was stopped.
std::vector<Verdict> diagnose_each(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                                   const Baseline& baseline, const DiagnoseOptions& options = {});

}  // namespace servodx
