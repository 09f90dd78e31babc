// Baseline: what fault-free logs score under a tuned table, and the threshold that promises a rate of false alarms.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {

struct BaselineParts;  // the library's own

struct BaselineOptions {
  double false_alarm = 0.01;  // asked for, of a healthy log; n logs promise no less than 1/(n + 1)
  std::uint64_t seed = 1;
  // Fault-free logs of other tests, those that tuned the table as well: how the model errs on tests that the baseline
  // does not hold. They set no threshold of a log whose test it holds, and promise no rate.
  std::vector<Log> others = {};
  int threads = 0;   // 0: all cores; the result does not depend on it
  Watch watch = {};  // stopped: of the logs done so far

  // Throws InputError that names the option.
  void validate() const;
};

struct Baseline {
  struct Score {
    std::string log, sha256;              // sha256 of the file's bytes; empty: the log came from memory
    double score = 0;                     // [deviates] largest gain of any fault over health, beside the other logs'
    double adequacy = 0;                  // whitened rms of the worst channel; 1 as on the tuning logs
    std::map<std::string, double> gains;  // of each fault over health
    std::string content;                  // content_hash of the log; empty: an earlier version did not keep it
  };
  double threshold = 0;                                // of a score [deviates]
  double asked = 0.01, promised = 0, promised_95 = 0;  // false-alarm rates; promised_95: at 95 % confidence
  int logs = 0;                                        // that set the threshold
  int logs_needed = 0;                                 // for the rate asked for
  std::vector<Score> scores;
  std::string tuned_sha256;  // content_hash of the table it speaks of; earlier versions wrote that of its file
  std::string path;          // of its file; empty where it was made in memory
  std::string sha256;        // of what its file holds, or would hold
  std::string rig_file;      // that it was made with, as its file says; empty: none, or made in memory
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;  // fewer logs than were given
  std::shared_ptr<const BaselineParts> parts;
};

// Refuses logs that tuned the table (by content), the same log twice, fewer than three logs. Throws InputError.
void require_baseline_logs(const std::vector<Log>& logs, const Tuned& tuned, const BaselineOptions& options = {});
// After the same.
Baseline make_baseline(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                       const BaselineOptions& options = {});

// Throws InputError naming the file, the key, the rule and the mend.
Baseline read_baseline(const std::string& path);
// As `servodx baseline -o` writes; one that was read is written back byte for byte.
void write_baseline(const std::string& path, const Baseline& baseline);

// Throws InputError where the file says nothing of causes, as earlier versions wrote it: explain() needs them,
// diagnose() does not.
void require_causes(const Baseline& baseline);

// What makes a verdict beside it doubtful: a rig file that says other things than the one that it was made with, a log
// that is one of its own, and channels that every healthy log holds and a log lacks. Throws InputError where there is
// nothing in the baseline. Empty where an earlier version made it.
std::vector<Note> notes_beside(const Baseline& baseline, const Rig& rig, const std::vector<Log>& logs);

// Throws InputError where the baseline was made with another table: its threshold is a statement about that table's
// residuals. Every call that takes both asks for it. A comment in the table is no change, a row is, in memory too.
// Returns a note where an earlier version bound the baseline to the bytes of the table's file.
std::optional<Note> require_same_table(const Baseline& baseline, const Tuned& tuned);

}  // namespace servodx
