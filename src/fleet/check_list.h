// The checks of a fleet as a CSV with a header: log, valve, hours; and where they are known cycles, serial, params.
//
// A path is relative to the working directory, as in a list of logs. A row whose first cell begins with '#' is skipped.
// `params` is the tuned table of the row's valve. Only the rows are kept, no log is read.
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace servodx {

struct CheckRow {
  std::string log, valve;
  double hours = 0;                   // of use
  std::optional<double> cycles = {};  // of use, where counted
  std::string serial = {};            // empty: not known
  std::string params = {};            // empty: the call's
  long line = 0;
};

struct CheckList {
  std::vector<CheckRow> rows;            // in the order of the file
  std::vector<std::string> passed_over;  // columns that no check takes
};

// `params`: the call's table, empty where it names none. Throws InputError at line and column; "-" is standard input.
CheckList read_check_list(const std::string& path, const std::string& params);

// What sets the results of one log apart in a folder: the valve and the hours.
std::string use_of(const CheckRow& row);

}  // namespace servodx
