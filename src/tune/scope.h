// What a tune fits to what: the logs made ready, the table with the effects asked for and the data sheet's facts, and
// the free numbers: rows that all logs share, and each log's own.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "fit/chart.h"
#include "fit/log_data.h"
#include "fit/problem.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"
#include "tune/tune.h"

namespace servodx {

struct TuneScope {
  std::vector<LogData> data;
  Table table;           // with rows of the effects and the facts
  ParameterVector base;  // its candidate
  RigFile facts;
  std::vector<FreeValue> shared, nuisances;
  SimulateOptions simulate;
  bool on_stand = false;
  std::vector<Note> notes;

  std::vector<const LogData*> logs() const;
  std::vector<FreeValue> all() const;  // shared first
  FitProblem problem() const { return FitProblem(logs(), base, all(), simulate); }
  // Without the last part of each log, held out.
  TuneScope seen(double held) const;
  // The first seconds of each log; a test stand's slow sweep shows one end in them, so all of it.
  TuneScope first_seconds(double seconds) const;
};

// Samples of a log of so many that a fit sees where the last part is held out.
inline std::size_t seen_samples(std::size_t samples, double held) {
  return static_cast<std::size_t>((1.0 - held) * static_cast<double>(samples));
}

// Throws InputError where the logs, the table or a prior cannot be used.
TuneScope scope_of(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig, const TuneOptions& options);

}  // namespace servodx
