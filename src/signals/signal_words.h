// The words by which people name signals and units on their rigs: English, German, Italian, French, Spanish,
// Portuguese, Polish, Swedish, Dutch, Russian, Chinese, Japanese, Korean.
#pragma once
#include <optional>
#include <span>
#include <string_view>

#include "base/units.h"
#include "servodx/log.h"

namespace servodx {

// Words that all must stand in a name, with blanks between, in small letters without accents; a single one with letters
// of another alphabet as a part of it.
struct SignalWords {
  Signal signal;
  std::string_view words;
  bool weak = false;  // says little of which signal of its kind it is: to be asked
};
// Most telling first within a signal.
std::span<const SignalWords> signal_words();

// Words of a name that is no signal of the valve's, whatever else it holds: an error of the control loop, a motor's
// current, the temperature of the room.
struct OtherWords {
  std::string_view words;
  std::optional<Dimension> of = {};  // of signals of this kind alone; none: of every signal
  std::string_view unless = {};      // with this word it may be the valve's all the same: its torque motor
};
std::span<const OtherWords> other_words();
std::span<const std::string_view> demand_words();      // of what is asked for, and not measured
std::span<const std::string_view> difference_words();  // of a pressure from one place to another
std::span<const std::string_view> machine_words();     // that a letter behind them tells apart: "valve A"
std::span<const std::string_view> valve_words();       // ends of words, or parts in an alphabet without blanks
std::span<const std::string_view> generic_words();     // words of signals that name many other things too
std::span<const std::string_view> neutral_words();     // that change nothing of what a generic one means

// How else people write units of the table, in small letters.
struct UnitWord {
  std::string_view word, unit;
};
std::span<const UnitWord> unit_words();

// Units of what is no signal, such as a speed, in small letters and without blanks.
std::span<const std::string_view> units_of_no_signal();

// Units beyond the table, in small letters and without blanks, and what would make them one of it.
struct ForeignUnit {
  std::string_view word;
  std::string_view unit;    // of the table
  std::string_view gain;    // as in a rig file
  std::string_view offset;  // empty: none
};
std::span<const ForeignUnit> foreign_units();

}  // namespace servodx
