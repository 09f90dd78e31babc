// Prognosis: the checks of one log, a valve's history of them, and from that its state and the life left.
// docs/prognosis.md.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {

struct CheckResult;  // the library's own
struct SeededTest;
struct ValveTrend;
class HistoryFile;

struct CheckOptions {
  std::string model = "linear";   // pressure model of the monitor: `servodx list models`
  int threads = 0;                // 0: all cores; the result does not depend on it
  bool track = true;              // fit the parameters that wear moves
  bool correct = true;            // to oil at 40 degC and the table's supply
  std::vector<double> last = {};  // History::tracked() of the valve: another start of the fit; may be empty
  Watch watch = {};               // stopped: what comes back says `interrupted` and nothing else

  // Throws InputError naming the option.
  void validate() const;
};

struct Checked {
  struct Figure {
    std::string name;                 // mean_error, fidelity, correlation@5Hz, parameter:ID
    double value = 0, std_error = 0;  // [unit] corrected
    std::string unit;
  };
  std::string log, sha256;
  std::vector<Figure> figures;
  double temperature = 0;  // [K] of the oil: the log's, or estimated
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
  std::shared_ptr<const CheckResult> whole;  // for the program's pages
};

// One log's checks: mean error, fidelity and correlation of Borello, Dalla Vedova, Jacazio & Sorli, "A Prognostic Model
// for Electrohydraulic Servovalves" (PHM Society 2009), section 6, and the parameters that wear moves. Throws
// InputError for a log that holds no check and for an option out of range.
Checked check(const Log& log, const Tuned& tuned, const Rig& rig, const CheckOptions& options = {});

// One file for many valves (SQLite). What record() has returned from survives a crash. Copies are the same history.
class History {
 public:
  // Throws InputError for a file that is not there, and for one that is no history.
  static History open(const std::string& path);
  // Makes it where it is not there. Throws InputError for a file that is no history.
  static History open_or_make(const std::string& path);
  static bool there(const std::string& path);  // false also of an empty file, which open_or_make() makes whole
  static int schema();                         // of the files that are written

  struct Use {
    double at = 0;  // [h] of use
    std::optional<double> cycles = {};
    std::string serial = {};  // number of the valve; empty: not known
  };
  // All of it or nothing. Throws InputError for a log that this valve's history holds already, unless at other hours or
  // by another table.
  void record(const std::string& valve, const Use& use, const Checked& checked, const Tuned& tuned);
  // Whether record() would refuse a log of these bytes.
  bool holds(const std::string& valve, double at, const std::string& log_sha256, const Tuned& tuned) const;
  // kind: filter_changed, valve_swapped, overhauled, retuned or note; InputError for another. It restarts the trends
  // that it renews.
  void add_event(const std::string& valve, double at, const std::string& kind, const std::string& text = "");
  std::vector<std::string> valves() const;
  std::string serial(const std::string& valve) const;  // number of the valve; empty where none is known
  std::string verify() const;                          // "ok", or what is damaged
  // For CheckOptions::last; empty where the valve is new.
  std::vector<double> tracked(const std::string& valve) const;
  const HistoryFile& file() const { return *file_; }

 private:
  explicit History(std::shared_ptr<HistoryFile> file) : file_(std::move(file)) {}
  std::shared_ptr<HistoryFile> file_;
};

// Where a check says that the valve has failed; without one of the user's the fault's own level holds.
struct FailureLevel {
  std::string check = {};  // "fidelity", "parameter:22"
  enum class Kind { above, below, times_healthy, current } kind = Kind::above;
  double value = 0;  // [unit of the check]; times_healthy [1]; current [A] that the spool's friction takes
  std::optional<double> spread = {};  // how well it is known: one standard deviation
};

// Of a user's words: "fidelity=1.7" above, "parameter:3=<20" below, "parameter:14=20x" times the tuned value (of the
// paper's checks: the healthy one), "parameter:14=0.9e-3A" the current that the spool's friction takes; "~1e-6" behind
// it is the spread. Throws InputError.
FailureLevel failure_level(const std::string& words);
// What performance limits of a valve come to, by its table: "bandwidth=0.5", "gain=0.5", "hysteresis=0.04",
// "phase_margin=45", "margin=6dB", "margin=45deg". `loop`: velocity gain of the position loop [1/s], for the margins.
// Throws InputError for a limit that is not known, out of range, or that the healthy valve does not hold.
std::vector<FailureLevel> failure_levels(const std::vector<std::string>& limits, const Tuned& tuned, double loop = 0);

// What checks of valves with wear of known size read; docs/prognosis.md has the columns. Throws InputError.
std::shared_ptr<const SeededTest> read_seeded_test(const std::string& path);

struct TrendOptions {
  double false_alarm = 0.01;                      // part of healthy valves that may raise an alert
  int healthy = 12;                               // first checks taken as healthy
  double coverage = 0.9;                          // of the interval of the life left
  std::vector<FailureLevel> limits = {};          // of failure_levels(); a level below comes before them
  std::vector<FailureLevel> failures = {};        // the user's, of checks that the library makes or the history holds
  std::shared_ptr<const SeededTest> seeded = {};  // parameters are taken to the wear at which these read the same
  std::uint64_t seed = 1;
  int threads = 0;   // 0: all cores; the result does not depend on it
  Watch watch = {};  // stopped: no check is told, and a note says so; it has no progress

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

struct Trend {
  // How far it has come, in the order of what calls for more. blind: one check cannot tell failure from health at the
  // false-alarm rate asked, only a trend can.
  enum class State { unknown, blind, healthy, watch, warning, failed };
  struct Remaining {
    double median = 0, lower = 0, upper = 0;  // [h]; infinite where never
  };
  struct OfCheck {
    std::string name, unit;
    State state = State::unknown;
    double slope = 0;                     // [unit / h]
    std::optional<double> alert_at = {};  // [h]
    std::optional<Remaining> remaining = {};
  };
  std::string valve, serial;
  State state = State::unknown;
  double at = 0;  // [h] of the last check
  std::size_t checks = 0;
  std::string cause;                   // label of a fault; empty: none
  std::optional<double> alert_at;      // [h]
  std::optional<Remaining> remaining;  // to failure
  std::vector<OfCheck> trends;
  std::vector<Note> notes;
  std::shared_ptr<const ValveTrend> whole;  // for the program's pages
};

std::string name_of(Trend::State state);

// Throws InputError for a valve that the history does not know, and for a level of what is no check.
Trend trend(const History& history, const std::string& valve, const TrendOptions& options = {});
// The first to reach its warning level first; of those that have passed it, the first to fail.
void most_urgent_first(std::vector<Trend>& trends);

}  // namespace servodx
