// What a tune fits to what: the logs made ready, the table with the effects asked for and the data sheet's facts, and
// the free numbers: rows that all logs share, and each log's own.
#pragma once
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
};

// Throws InputError where the logs, the table or a prior cannot be used.
TuneScope scope_of(const std::vector<Log>& logs, const Table& nominal, const RigFile& rig, const TuneOptions& options);

}  // namespace servodx
