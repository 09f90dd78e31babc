// `check-log`: what a log holds, what it could identify, and what is suspicious about it, before any fit.
//
// The survey reads the samples only. What it can identify is local: the sensitivities of the model at the table's
// values on this log's inputs, against the errors the model is known to make (a tuned table) or, without these, against
// twice the sensor's noise with 40 independent samples a second. A fault's visibility is the deviate by which the log
// would differ, the log's own nuisances fitted away: below about 3 the fault at that size stays hidden.
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {

struct ChannelSurvey {
  Signal signal;
  std::string column, unit;  // as in the file
  std::size_t missing = 0;
  double lowest = 0, highest = 0;  // [SI]
  double noise = 0;                // [SI] rms, of the sensor
  double resolution = 0;           // [SI] smallest step between distinct values; 0 unknown
  double full_scale = 0;           // [SI] what a relative unit is a part of; 0: the unit is absolute
  double clipped = 0;              // part of the samples that lie on the lowest or the highest value, in runs
};

enum class FindingKind {
  jitter,        // of the time stamps
  gaps,          // in time
  rate,          // another than the other logs have
  temperature,   // cold or hot oil, or another than the other logs have
  repeats,       // rows that repeat the row before
  missing,       // samples of a signal
  saturation,    // a sensor or converter at its limit
  quantisation,  // steps that hide the noise
  sign,          // a signal runs against the drive
  swapped,       // two columns exchanged
  response,      // nothing that is measured moves
  values,        // what the reader left out or found hardly possible
  columns,       // the rig file maps one that the log lacks
  beyond,        // the operating point, beyond what is known
  return_line,   // a return pressure that takes much of the supply
};

struct Finding {
  FindingKind kind = FindingKind::values;
  std::string text;
  std::vector<Signal> signals = {};  // whose columns may be meant wrongly; of a sign and of exchanged columns
  bool impossible = false;           // of no valve; what a fit would make of it is worth nothing
  bool notice = false;               // to be known, and no matter of suspicion: columns that are no signals
};

struct LogSurvey {
  std::string path, sha256;
  std::size_t samples = 0;
  double duration = 0, rate = 0;         // [s], [Hz] from the usual step
  double jitter = 0;                     // rms of the steps about the usual one, gaps left out, over it
  std::size_t gaps = 0, lost = 0;        // gaps in time; samples they took
  double longest_gap = 0;                // [s]
  std::optional<double> temperature;     // [K] mean
  double drive_span = 0;                 // [A] greatest less least drive
  double drive_band = 0;                 // [Hz] of the sine that changes as fast as the drive
  std::vector<ConditionRow> conditions;  // where it was recorded, beside the sheet
  bool closed_loop = false;              // it has a setpoint
  std::vector<ChannelSurvey> channels;
  std::vector<Finding> findings;
};

LogSurvey survey(const Log& log, const Rig& rig);
// What only stands out beside the others: another rate, another temperature.
void compare_surveys(std::vector<LogSurvey>& surveys);

struct Identifiable {
  std::string name, unit;
  RowVerdict verdict = RowVerdict::bounded;  // or flat, confounded
  double nominal = 0, std_error = 0;         // [unit]; NaN where held
  std::vector<std::string> confounded_with;
};

struct Visible {
  std::string fault, unit;
  double least = 0, typical = 0;  // severities
  double deviates_at_least = 0, deviates_at_typical = 0;
};

struct Promise {
  std::vector<Identifiable> rows;
  std::vector<Visible> faults;
  bool error_known = false;  // the table is tuned
  long simulations = 0;
};

// Throws InputError where the log lacks a signal that the model reports.
Promise promise_of(const Log& log, const Table& table, const Rig& rig, int threads = 0);

}  // namespace servodx
