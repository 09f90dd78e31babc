// The one closed table of units: every unit a log, a rig file or an option may carry, with its dimension and its way to
// SI. Inside the program all numbers are SI; this table is used at the boundary only.
//
// Limits: names are matched exactly ("mA", not "ma"); compound units are listed, not parsed, except a gain's "A/B".
// Relative units ('% of rated', '% of stroke') and volts mean nothing without a fact: the rated current, the spool
// stroke, a sensor gain. They have a dimension of their own, so they are never taken for an absolute quantity.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/error.h"

namespace servodx {

enum class Dimension {
  fraction,
  time,
  frequency,
  length,
  area,
  volume,
  mass,
  density,
  kinematic_viscosity,
  current,
  voltage,
  pressure,
  force,
  stiffness,
  flow,
  temperature,
  percent_of_rated,   // of the rated current; SI value is the fraction
  percent_of_stroke,  // of the spool stroke at rated current; SI value is the fraction
  angle,
  level  // of a gain, [dB]: no other unit
};

// SI = x * multiply / divide + offset. Two exact factors keep "20 mA" equal to 0.02 bit for bit.
struct Unit {
  std::string_view name;
  Dimension dimension;
  double multiply = 1.0;
  double divide = 1.0;
  double offset = 0.0;  // [SI]

  double to_si(double x) const { return x * multiply / divide + offset; }
  double from_si(double si) const { return (si - offset) * divide / multiply; }
  double scale() const { return multiply / divide; }
};

std::span<const Unit> unit_table();
const Unit* find_unit(std::string_view name);          // null: unknown
std::string_view name_of(Dimension dimension);         // "pressure"
std::string units_of(Dimension dimension);             // "Pa, kPa, MPa, bar, psi"
std::optional<double> parse_number(std::string_view);  // whole text, '.' decimals, finite; no unit

struct Quantity {
  double value;      // [SI]
  const Unit* unit;  // as written
};

// "20 mA" -> 0.02 A. Throws InputError at `where` for a missing or unknown unit, another dimension, or no number.
Quantity parse_quantity(std::string_view text, Dimension expected, const Place& where);

struct Gain {
  double value;             // [SI of numerator per SI of denominator]
  const Unit* numerator;    // null for a plain number ("-1")
  const Unit* denominator;  // null for a plain number
};

// "20 mm/V" or "-1". Offsets of temperature units do not enter a gain.
Gain parse_gain(std::string_view text, Dimension expected, const Place& where);

}  // namespace servodx
