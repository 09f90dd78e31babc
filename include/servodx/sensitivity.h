// The sensitivity table of the GA fault diagnosis paper: every row of a table, held ones too, driven to its minimum and
// to its maximum while all others stay, ranked by what that does to the simulation.
//
// Effect: rms change of the simulated signals over their sensors' noise, of all logs and channels together. Signals are
// filtered as for a fit, so the piston's drift below 1 Hz does not count. Limits: one row at a time, from these values;
// what two rows do together is not seen, and a row that these logs do not excite looks weak.
#pragma once
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/watch.h"

namespace servodx {

struct DrivenEnd {
  double value = 0;                 // [unit of the row] the bound
  double effect = NAN;              // [-] of the logs that ran; NaN where none did
  std::vector<double> by_channel;   // [-] the same, by Sensitivity::channels; NaN where no log has it
  std::vector<std::string> failed;  // logs whose simulation fails there
};

struct DrivenRow {
  int id = 0;  // of the 41; 0: of an effect
  std::string name, unit;
  bool estimate = false;          // free in a tune
  double nominal = 0;             // [unit]
  std::array<DrivenEnd, 2> ends;  // minimum, maximum

  double largest() const;  // effect; NaN where no end ran
};

struct Sensitivity {
  std::vector<Signal> channels;
  std::vector<DrivenRow> rows;  // largest effect first, then those that failed at both ends
  long simulations = 0, failed_simulations = 0;
  bool interrupted = false;  // fewer logs than were given
};

// Throws InputError where a log has no signal that is simulated, or the simulation fails at the table's own values.
// `table`: facts of `rig` are in it (servodx/data_sheet.h). `threads` 0: all cores; the result does not depend on it.
Sensitivity drive_rows(const std::vector<Log>& logs, const Table& table, const Rig& rig, int threads = 0,
                       const Watch& watch = {});

}  // namespace servodx
