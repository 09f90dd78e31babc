// What a column of a user's log may be: its signal and unit, guessed from the header cell alone.
//
// Words of English and German rigs; a guess is a starting point for a person to correct: a reader takes from here only
// that a row of units is no row of samples.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/csv.h"
#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {

struct ColumnGuess {
  std::string cell;               // as it stands in the header
  std::string name;               // without its unit
  std::optional<Signal> signal;   // empty: not recognised
  std::string unit;               // of the closed table; empty: none or not recognised
  bool unit_in_brackets = false;  // a unit of the table, in "name [unit]" or in the row below: the reader takes it
  bool canonical = false;         // the name is the signal's own
};

// The unit of the closed table that people mean by a word: "PSI", "deg C", "lpm"; empty: none.
std::string unit_meant(const std::string& written);

// Takes the header from below the lines that a recorder wrote above it, and says how many rows those are. Certain, as
// it looks only where the first row has another number of cells than the first row of numbers, which is refused else:
// then the row above the numbers is the header, or the one above that where it is one of units.
long pass_lines_above_header(CsvCursor& csv);

// The row that a cursor stands at, where it is one of units below a header: no cell is a number, one at least is a
// unit. Without their brackets; empty: it is none.
std::vector<std::string> units_row(CsvCursor& csv);

// Each signal once: the better match wins, then the first column. `units`: of a row below the header, a cell a column.
std::vector<ColumnGuess> guess_columns(const std::vector<std::string>& header,
                                       const std::vector<std::string>& units = {});

}  // namespace servodx
