// A column as a user's own file has it: its name, its unit, and the way from SI back to its numbers.
//
// The rig file may give a column a name of the user's, volts, a gain and an offset; what is written for that user again
// has all of them, so that it stands beside the log and is read by the same rig file.
#pragma once
#include <string>
#include <vector>

#include "base/units.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {

struct FileColumn {
  std::string name, unit;     // "Pos fb", "V"
  Unit scale;                 // its numbers to SI, gain and offset in it
  std::vector<double> value;  // [SI] NaN is written as an empty cell
};

// Of a signal that `log` holds, as the log's file has it; canonical where the log says no more.
FileColumn file_column(const Log& log, const Rig& rig, const OutputColumn& column);

// As write_log writes. Throws InputError where a unit is none of the signal.
void write_columns(const std::string& path, const std::vector<FileColumn>& columns,
                   const std::vector<std::string>& comments = {});

}  // namespace servodx
