// The rows that a hypothesis moved, with their errors: the fault's own first, then the tolerances that it shares with
// health, then the log's nuisances.
#pragma once
#include <vector>

#include "diagnose/hypotheses.h"
#include "fit/log_data.h"
#include "parameters/table.h"
#include "servodx/tune.h"
#include "simulate/scenario.h"
#include "tune/tune.h"

namespace servodx {

struct MovedRow : ParameterResult {
  enum class By { fault, tolerance, nuisance } by = By::nuisance;
};

// `base`: the tuned candidate. Of several logs the first. Rows of the table and of effects; a sensor's offset and the
// like are no valve's rows. A value that ended on a bound has no error.
std::vector<MovedRow> moved_rows(const HypothesisFit& fit, const ParameterVector& base, const Table& tuned);

}  // namespace servodx
