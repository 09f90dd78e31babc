// What a column of a user's log may be: its signal and unit, guessed from the header cell alone.
//
// A guess is a starting point for a person to correct (signal_words.h has the words): a reader takes from here only
// that a row of units is no row of samples.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {

struct ColumnGuess {
  std::string cell;               // as it stands in the header
  std::string name;               // without its unit
  std::optional<Signal> signal;   // empty: not recognised
  std::string unit;               // of the closed table; empty: none or not recognised
  std::string written_unit;       // as it stands in the header; empty: none
  std::string gain, offset;       // as in a rig file, for a unit beyond the table; empty: none
  bool offset_is_open = false;    // there is one, and only the user can say it
  bool gain_is_open = false;      // so it is of the gain: milliamperes of a transmitter
  std::string question;           // what only the user can say; empty: nothing of name and unit
  bool by_numbers = false;        // the unit is taken by the values, not from the header
  bool weak = false;              // the name says little of which signal of its kind it is
  std::optional<Signal> rival;    // what the name may as well mean: "T Tank"
  bool unit_in_brackets = false;  // a unit of the table, in "name [unit]" or in the row below: the reader takes it
  int points = 0;                 // of the match that gave the signal
  bool canonical = false;         // the name is the signal's own

  bool has_offset() const { return offset_is_open || !offset.empty(); }
  void ask(const std::string& more) { question += (question.empty() ? "" : "; ") + more; }
};

// The unit of the closed table that people mean by a word: "PSI", "deg C", "lpm"; empty: none.
std::string unit_meant(const std::string& written);

// Whether people write a unit so, one beyond the table or of no signal included: "kp/cm2", "rpm".
bool is_unit_as_written(const std::string& written);

// Milliamperes of what is no current: a transmitter's 4 to 20.
bool is_transmitters(const std::string& unit, Signal signal);

// Each signal once: the better match wins, then the first column. `units`: of a row below the header, a cell a column.
std::vector<ColumnGuess> guess_columns(const std::vector<std::string>& header,
                                       const std::vector<std::string>& units = {});

}  // namespace servodx
