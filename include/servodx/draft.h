// A rig file's [columns] to begin with, from the header and the numbers of a log with the user's own names. A draft is
// for a person to correct: what only the user can say is a question. docs/logs.md.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"

namespace servodx {

struct ColumnDraft {
  std::string column;            // as it stands in the header
  std::optional<Signal> signal;  // empty: not recognised
  std::string unit;              // of those that are read; empty: none or not recognised
  std::string written_unit;      // as it stands in the header; empty: none
  std::string values;            // "0 to 250", "time stamps", "no numbers"
  std::string question;          // empty: nothing is open
  std::string line;              // of a rig file: a mapping, or a comment where one need or can not be, or is asked for
  bool read_as_it_is = false;    // by its own name and unit
  bool by_numbers = false;       // the header has no unit: it is taken by the values
  bool counts = false;           // goes up by one in every row
};

// CSV or MAT. Throws InputError for what has no header or no numbers.
std::vector<ColumnDraft> draft_columns(const std::string& log);

}  // namespace servodx
