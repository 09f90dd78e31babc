// Tune: nominal parameters from fault-free logs, pooled.
//
// A genetic search and a least-squares fit, weighed by what the model itself gets wrong; docs/model.md and
// docs/performance.md say how and how long. A tuned table speaks of one valve on one rig.
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"

namespace servodx {

struct TuneResult;  // the library's own

// The local stage: our bounded search and then Ceres; Ceres alone; NLopt's BOBYQA alone, without derivatives.
enum class TuneLocal { least_squares, ceres, nlopt };

struct TuneOptions {
  std::uint64_t seed = 1;
  int threads = 0;       // 0: all cores; the result does not depend on it
  int population = 50;   // of the genetic search, which finds where the fits begin
  int generations = 30;  // of it; 0: the fit begins at the table's values alone
  int rounds = 4;        // most of the last stage: of 6 steps, the last of 10, new weights between them; it ends early
                         // where it converges
  double heldout = 0.2;  // last part of every log, kept out of the first fit
  std::optional<std::vector<std::string>> effects = {};  // freed beside the table's rows; empty: default_effects()
  // Priors asked for: by row, the standard deviation about the table's nominal [the table's unit].
  std::map<std::string, double> priors = {};
  TuneLocal local = TuneLocal::least_squares;
  std::vector<std::string> profile = {};  // rows whose interval is checked by profile likelihood; "all": every one
  int moving_average = 1;       // [samples] odd; smooths measurement and simulation alike, also in later commands
  std::string checkpoint = {};  // file of a checkpoint, opened where `watch` has none; empty: none
  bool resume = false;          // go on from that file
  Watch watch = {};             // stopped: finish with the best so far

  // Throws InputError that names the option, as the program calls it. tune() asks for it before any work.
  void validate() const;
};

// What decides which effects a rig's logs can tell.
struct RigKind {
  bool on_stand = false;                                // a valve on a test stand, not on an actuator
  bool supply_measured = true, return_measured = true;  // in every log
  bool temperatures_differ = false;                     // of the oil, by the logs
  bool long_lines = false;  // oil in the lines stands between the pressure taps and the cylinder, by the rig file
};
RigKind rig_kind(const std::vector<Log>& logs, const RigFile& rig);
// What a tune frees unless told.
std::vector<std::string> default_effects(const RigKind& kind);

// The table with a row for each number of these effects that it lacks, as a tune frees them.
Table with_effects(const Table& table, const std::vector<std::string>& effects);

struct ParameterResult {
  int id = 0;  // 0 for an effect's parameter
  std::string name, unit;
  double nominal = 0, estimate = 0;  // [unit]
  double std_error = 0;              // [unit]; NaN where there is none
  RowVerdict verdict = RowVerdict::bounded;
  std::vector<std::string> confounded_with;
  double profile_lower =
             std::numeric_limits<double>::quiet_NaN(),  // [unit] 95 % by profile likelihood, where asked for
      profile_upper = std::numeric_limits<double>::quiet_NaN();
  // How far the simulation of all logs moves with the row at its bounds: root of the sum of the squares of all samples'
  // moves, each over its sigma. NaN where the simulation fails there.
  double effect_at_lower = 0, effect_at_upper = 0;
};

struct ChannelResult {
  Signal signal;
  std::string unit;  // as in the log
  double rms = 0, noise_rms = 0,
         heldout_rms = 0;  // [SI] over all logs; held out: the last part of each log, before the final fit
};

struct Tuned {
  Table table;                              // with standard errors; what later calls rest on
  std::vector<ChannelResult> channels;      // how well it follows the logs
  std::vector<ParameterResult> parameters;  // free rows, effects included
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;                 // the best so far
  std::shared_ptr<const TuneResult> whole;  // for the program's pages; none of a table that was read
};

// Throws InputError where the table, with the effects' rows that a tune of these logs frees, lacks a row of
// `options.profile`: tune() asks for it before any fit.
void require_profiled_rows(const std::vector<Log>& logs, const Table& nominal, const Rig& rig,
                           const TuneOptions& options);

// `nominal`: where it begins; a tuned one is tuned on. Throws InputError where the logs cannot be used.
Tuned tune(const std::vector<Log>& logs, const Table& nominal, const Rig& rig, const TuneOptions& options = {});

// A tuned table from its file; `channels` and `parameters` are not in it. Refuses a table that is not tuned.
Tuned read_tuned(const std::string& path);
// The same bytes as `servodx tune -o` writes.
void write_tuned(const std::string& path, const Tuned& tuned);

}  // namespace servodx
