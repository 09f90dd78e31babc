// `tune`: nominal parameters from fault-free logs, pooled.
#pragma once
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "fit/error_model.h"
#include "fit/free_values.h"
#include "fit/identifiability.h"
#include "fit/recorder.h"
#include "fit/tuned_state.h"
#include "optimise/box_least_squares.h"
#include "optimise/ceres_refinement.h"
#include "optimise/local.h"
#include "optimise/search_stop.h"
#include "parameters/table.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "signals/log.h"
#include "simulate/scenario.h"

namespace servodx {

struct LogResult {
  std::string path;
  std::vector<ChannelResult> channels;
  double null = 0;                 // [fraction of rated]
  double command_slope = 0;        // command between samples: 0 held, 1 in a line to the next
  ParameterVector candidate = {};  // what the fit says of this log
};

// A part of the search.
struct Stage {
  enum class Kind {
    screening,  // what each row moves, alone and beside the others
    genetic,
    start,       // a local search of its own, with the end of each log held out
    weights,     // the best start goes on by what the model itself gets wrong, the same part held out
    effects,     // whether the held-out part needs each of those that were freed
    everything,  // on whole logs
    errors       // of the rows
  };
  Kind kind = Kind::genetic;
  int start = 0;  // 1: from the table's values; the others from points of the genetic search
  bool operator==(const Stage&) const = default;
};

// How the misfit fell. Each stage weighs residuals in its own way: levels compare within a stage only.
struct ConvergencePoint {
  Stage stage;
  long simulations = 0;
  double cost = 0;
};

enum class StageMethod { genetic, least_squares, ceres, nlopt, none };

// What a method has cost and gained in a stage, at that stage's weights.
struct StageResult {
  Stage stage;
  StageMethod by = StageMethod::least_squares;  // none: nothing is minimised there
  double before = 0, after = 0;                 // cost
  long simulations = 0;
  int jacobians = 0;
  double seconds = 0;
  // [-] rms of what was held out over the sensors' noise, geometric mean over the channels; NaN: not looked at, or not
  // held out.
  double heldout_over_noise = std::numeric_limits<double>::quiet_NaN();
};

// What an effect that was freed is worth: the fall of the held-out cost with it.
struct EarnedEffect {
  std::string effect;
  double gain = 0;
  bool kept = false;
};

// A start of the local stage and its end.
struct StartEnd {
  enum class From { table, rig_size, genetic };  // rig_size: the table's, with effects as large as the rig is
  From from = From::table;
  double cost = 0;
  bool in_best_valley = false;
};

struct TuneResult {
  Table table;  // the tuned table
  ErrorModel error;
  std::vector<ChannelResult> channels;
  std::vector<Unfollowed> unfollowed;  // of these; empty: good enough
  std::vector<OffDrawing> off_drawing;
  std::vector<LogResult> logs;
  std::optional<CommandSlope> command_slope;  // of the recorder, over the logs
  std::vector<ParameterResult> parameters;
  std::vector<StartEnd> starts;
  StopReason stop = StopReason::converged;  // of the last fit
  SearchStop search_end;                    // the same, closer
  Distrust distrust = Distrust::none;       // of its derivatives
  double cost = 0;                          // half a sum of squares
  double still_promised = 0;                // of it, by its derivatives; infinite where it had none
  int reached_best() const { return static_cast<int>(std::ranges::count(starts, true, &StartEnd::in_best_valley)); }
  std::vector<ConvergencePoint> convergence;
  std::vector<StageResult> stages;
  std::vector<EarnedEffect> effects;  // in the order of trial
  CeresSummary ceres;                 // of the last fit
  // Of logs and rows; and of what the last fit says log by log. Between the two report tells how that fit ended.
  std::vector<Note> notes, notes_by_log;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
};

// Throws InputError where the logs cannot be used.
TuneResult tune_table(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig,
                      const TuneOptions& options);

}  // namespace servodx
