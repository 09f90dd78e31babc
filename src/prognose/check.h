// `check`: everything one log says about a valve's health, corrected to one reference state.
//
// Correction, by physics: the identification model runs on the same current twice, once as this log was (its oil,
// supply and load, with the null, air and sensor offsets fitted to it), once with oil at 40 degC and the table's
// supply. Both runs go through the same check; the measured figure is divided by their ratio, `expected`. So a cold
// preflight, which moves r and E although nothing has worn, is no alarm. How far the model's ratio can be trusted the
// valve's own history tells: `trend` learns it. |e| is not corrected: in service the oil is warm.
//
// The temperature is the log's, or estimated: the oil at which a healthy model fits best, from -40 to 100 degC. An
// estimate is worth what its error says, and it can mistake wear for cold; the result says which it is.
#pragma once
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "parameters/table.h"
#include "prognose/check_name.h"
#include "prognose/checks.h"
#include "prognose/oil_temperature.h"
#include "prognose/track.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/trend.h"
#include "signals/log.h"

namespace servodx {

struct Check {
  CheckName name;  // mean_error, fidelity, correlation@5Hz, parameter:ID
  double value = 0, std_error = 0;
  std::string unit;
  double measured = 0;  // before the correction
  double expected = 1;  // what a healthy valve would measure here, over what it would at the reference state
  std::string cause;    // fault label of a parameter; empty for the paper's checks
  double tuned = NAN, failed = NAN;  // of a parameter, not stored: the table's value, and where the fault has failed
  double whole_error = NAN;  // of a parameter, not stored: with the model's own error, which a trend does not see
  bool told = false;         // from the tuned value, by that error and what else the model leaves open
  std::optional<TrackedAlong> along = {};  // of a parameter, not stored: what wears with it
};

struct CheckResult {
  std::string log, sha256;
  OilTemperature temperature;
  std::vector<Check> checks;
  double offset = 0;            // [of rated] current at rest less what the spool at rest calls for
  std::optional<double> null;   // [of rated] fitted
  bool no_response = false;     // the spool did not follow the preflight step
  std::vector<double> tracked;  // values of the parameters, in the order of progressive_faults()
  double adequacy = 0;
  MeanError mean_error;  // with its running curve
  std::vector<Note> notes;
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;  // nothing else is told then
};

CheckResult check(const Log& log, const Table& tuned, const RigFile& rig, const CheckOptions& options);

}  // namespace servodx
