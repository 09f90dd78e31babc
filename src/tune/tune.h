// `tune`: nominal parameters from fault-free logs, pooled.
#pragma once
#include <atomic>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fit/error_model.h"
#include "fit/identifiability.h"
#include "fit/tuned_state.h"
#include "optimise/ceres_refinement.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "signals/log.h"
#include "signals/rig_file.h"
#include "simulate/scenario.h"

namespace servodx {

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
  double effect_at_lower = 0,
         effect_at_upper = 0;  // whitened rms change of the simulation at the row's bounds, in sigmas
};

struct ChannelResult {
  Signal signal;
  std::string unit;  // as in the log
  double rms = 0, noise_rms = 0,
         heldout_rms = 0;  // [SI] over all logs; held out: the last part of each log, before the final fit
};

struct LogResult {
  std::string path;
  std::vector<ChannelResult> channels;
  double null = 0;                 // [fraction of rated]
  double command_slope = 0;        // command between samples: 0 held, 1 in a line to the next
  ParameterVector candidate = {};  // what the fit says of this log
};

// How the misfit fell. Each stage weighs residuals in its own way: levels compare within a stage only.
struct ConvergencePoint {
  std::string stage;  // "genetic search", "start 1", ..., "refine"
  long simulations = 0;
  double cost = 0;
};

enum class StageMethod { genetic, least_squares, ceres, nlopt };

// What a method has gained in a stage, at that stage's weights.
struct StageResult {
  std::string stage;  // as in ConvergencePoint
  StageMethod by = StageMethod::least_squares;
  double before = 0, after = 0;  // cost
  long simulations = 0;
  int jacobians = 0;
};

// The local stage: our bounded search and then Ceres; Ceres alone; NLopt's BOBYQA alone, without derivatives.
enum class TuneLocal { least_squares, ceres, nlopt };

struct TuneOptions {
  std::uint64_t seed = 1;
  int threads = 0;
  bool quiet = false;
  int population = 50;
  int generations = 30;
  int rounds = 4;        // most of the last stage (12 steps, then new weights); it ends early where it converges
  double heldout = 0.2;  // last part of every log, kept out of the first fit
  std::optional<std::vector<std::string>> effects;  // freed beside the table's rows; empty: default_effects()
  // Priors asked for: by row, the standard deviation about the table's nominal [the table's unit].
  std::map<std::string, double> priors;
  TuneLocal local = TuneLocal::least_squares;
  std::vector<std::string> profile;  // rows whose interval is checked by profile likelihood; "all": every one
  int moving_average = 1;            // [samples] odd; smooths measurement and simulation alike, also in later commands
  std::string checkpoint;            // file saved every generation; empty: none
  bool resume = false;
  const std::atomic<bool>* stop = nullptr;  // set: finish with the best so far

  // Throws InputError that names the option. tune_table() asks for it before any work.
  void validate() const;
};

// What a tune frees unless told: of a valve on an actuator, and of one on a test stand.
std::vector<std::string> default_effects(bool on_stand, bool supply_measured);
bool supply_is_measured(const std::vector<Log>& logs);  // in every one

struct TuneResult {
  Table table;  // the tuned table
  ErrorModel error;
  std::vector<ChannelResult> channels;
  std::vector<LogResult> logs;
  std::vector<ParameterResult> parameters;
  std::vector<double> starts;  // final costs of all local starts
  int reached_best = 0;
  std::vector<ConvergencePoint> convergence;
  std::vector<StageResult> stages;
  CeresSummary ceres;  // of the last fit
  std::vector<std::string> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;
};

// Throws InputError where the logs cannot be used.
TuneResult tune_table(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig,
                      const TuneOptions& options);

}  // namespace servodx
