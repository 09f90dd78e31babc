// What a column of a user's log may be: its signal and unit, guessed from the header cell alone.
//
// Words of English and German rigs; a guess is a starting point for a person to correct, never used by a reader.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "signals/signal.h"

namespace servodx {

struct ColumnGuess {
  std::string cell;               // as it stands in the header
  std::string name;               // without its unit
  std::optional<Signal> signal;   // empty: not recognised
  std::string unit;               // of the closed table; empty: none or not recognised
  bool unit_in_brackets = false;  // "name [unit]" with a unit of the table: the reader takes it from there
  bool canonical = false;         // the name is the signal's own
};

// Each signal once: the better match wins, then the first column.
std::vector<ColumnGuess> guess_columns(const std::vector<std::string>& header);

}  // namespace servodx
