// Explain: what the simulation gets wrong on these logs, where, why, and what mending it gains. docs/explain.md.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {

struct ExplainResult;  // the library's own

struct ExplainOptions {
  std::uint64_t seed = 1;
  int threads = 0;                        // 0: all cores; the result does not depend on it
  double level = 0.01;                    // false-alarm rate at which a cause counts as new
  std::vector<std::string> without = {};  // effects that are left out of the list
  bool keep_worse = false;  // write the extension even where the free simulation's held-out rms is worse with it
  Watch watch = {};         // stopped: what was found so far

  // Throws InputError naming the option.
  void validate() const;
};

struct Explanation {
  enum class Kind { sufficient, extended, unexplained };
  struct Gain {
    double value = 0, lower = 0, upper = 0;  // share of the held-out misfit that is removed, 90 %
  };
  struct Channel {
    std::string signal, unit;  // unit as in the first log that has it
    double rms_before = 0, rms_after = 0, noise_rms = 0, heldout_before = 0, heldout_after = 0;  // [SI]
  };
  struct Parameter {
    // at_bound: it stands at an end of where it may be. not_told: any size that may be is as likely.
    enum class Told { interval, at_bound, not_told };
    double value = 0, std_error = 0;  // [unit]
    std::string unit;
    double lower = 0, upper = 0;  // [unit] 90 %, within what is physical; NaN at a bound
    Told told = Told::interval;
  };
  struct Cause {
    std::string effect, where;
    std::map<std::string, Parameter> parameters;
    Gain heldout_gain;
    double delta_bic = 0;  // positive: worth its numbers
    std::vector<std::string> confusable_with;
  };
  struct Candidate {
    std::string effect, where, reason;  // why it was not taken, or that it was
    bool taken = false;
  };
  Kind kind = Kind::sufficient;
  std::string where;                            // of the first cause; empty: nowhere
  std::string depends_on;                       // of what no name explains: the variable that it follows
  std::vector<Channel> channels;                // before and after mending
  std::vector<Cause> causes;                    // new ones
  std::vector<Cause> standing;                  // what the healthy logs of the baseline show too
  std::vector<Candidate> candidates;            // all that were looked at
  std::map<std::string, double> probabilities;  // of causes, "unlisted" and "nothing"; empty without a baseline
  Table table;                                  // extended
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
  std::shared_ptr<const ExplainResult> whole;  // for the program's pages
};

// "sufficient", "extended" or "unexplained".
std::string name_of(Explanation::Kind kind);
// "interval", "at_bound" or "not_told".
std::string name_of(Explanation::Parameter::Told told);
// The keys that `servodx explain --json` writes behind its header.
std::string json_of(const Explanation& explanation);

// The logs are of one valve in one state. With a baseline it speaks of what is new against the healthy state, at the
// baseline's rate; without one, of everything. Throws InputError.
Explanation explain(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                    const ExplainOptions& options = {});
Explanation explain(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                    const ExplainOptions& options = {});

}  // namespace servodx
