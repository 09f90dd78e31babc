#include "base/units.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/celsius.h"
#include "base/trimmed.h"
#include "base/trouble.h"

namespace servodx {
namespace {

using enum Dimension;

// in = 0.0254 m, lbf = 4.4482216152605 N, psi = lbf/in2, US gallon = 231 in3: exact by definition.
constexpr Unit table[] = {
    {"-", fraction},
    {"%", fraction, 1, 100},
    {"s", time},
    {"ms", time, 1, 1e3},
    {"us", time, 1, 1e6},
    {"min", time, 60, 1},
    {"h", time, 3600, 1},
    {"Hz", frequency},
    {"kHz", frequency, 1e3, 1},
    {"m", length},
    {"cm", length, 1, 1e2},
    {"mm", length, 1, 1e3},
    {"um", length, 1, 1e6},
    {"in", length, 254, 1e4},
    {"m2", area},
    {"cm2", area, 1, 1e4},
    {"mm2", area, 1, 1e6},
    {"in2", area, 64516, 1e8},
    {"m3", volume},
    {"l", volume, 1, 1e3},
    {"cm3", volume, 1, 1e6},
    {"mm3", volume, 1, 1e9},
    {"in3", volume, 16387064, 1e12},
    {"kg", mass},
    {"g", mass, 1, 1e3},
    {"lb", mass, 45359237, 1e8},
    {"kg/m3", density},
    {"g/cm3", density, 1e3, 1},
    {"m2/s", kinematic_viscosity},
    {"mm2/s", kinematic_viscosity, 1, 1e6},
    {"cSt", kinematic_viscosity, 1, 1e6},
    {"A", current},
    {"mA", current, 1, 1e3},
    {"V", voltage},
    {"mV", voltage, 1, 1e3},
    {"Pa", pressure},
    {"kPa", pressure, 1e3, 1},
    {"MPa", pressure, 1e6, 1},
    {"bar", pressure, 1e5, 1},
    {"psi", pressure, 44482216152605.0, 6451600000.0},
    {"N", force},
    {"kN", force, 1e3, 1},
    {"lbf", force, 44482216152605.0, 1e13},
    {"N/m", stiffness},
    {"N/mm", stiffness, 1e3, 1},
    {"N/um", stiffness, 1e6, 1},
    {"lbf/in", stiffness, 44482216152605.0, 254e9},
    {"m3/s", flow},
    {"l/min", flow, 1, 6e4},
    {"l/s", flow, 1, 1e3},
    {"cm3/s", flow, 1, 1e6},
    {"gpm", flow, 3785411784.0, 6e13},
    {"K", temperature},
    {"degC", temperature, 1, 1, zero_celsius},
    {"degF", temperature, 5, 9, zero_celsius - 160.0 / 9.0},
    {"% of rated", percent_of_rated, 1, 100},
    {"% of stroke", percent_of_stroke, 1, 100},
    {"deg", angle, std::numbers::pi, 180},
    {"rad", angle},
    {"dB", level},
};

// Units with letters beyond ASCII, for those who can write them.
constexpr std::pair<std::string_view, std::string_view> spellings[] = {
    {"\xC2\xB0"
     "C",
     "degC"},
    {"\xE2\x84\x83", "degC"},
    {"\xC2\xB0"
     "F",
     "degF"},
    {"\xE2\x84\x89", "degF"},
    {"\xC2\xB5m", "um"},
    {"\xCE\xBCm", "um"},
    {"\xC2\xB5s", "us"},
    {"\xCE\xBCs", "us"},
    {"m\xC2\xB3/s", "m3/s"},
};

std::string quoted(std::string_view text) { return "'" + std::string(text) + "'"; }

// The number that a quantity opens with, and what follows it.
struct Split {
  double number;
  std::string_view rest;
};
std::optional<Split> split(std::string_view text) {
  text = trimmed(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
  return Split{number, trimmed(text.substr(static_cast<std::size_t>(end - text.data())))};
}

const Unit& unit_or_throw(std::string_view name, Dimension expected, const Place& where) {
  const Unit* unit = find_unit(name);
  // "2..5 um", "2-5 um", "2 to 5 um", "3,5 um": more numbers follow the first.
  if (!unit && name.find_first_of("0123456789") != std::string_view::npos && name.find_first_of(".,-t") == 0)
    throw InputError(where, quoted(name) + " follows the number: a range, or a decimal comma",
                     "give one number with a decimal point and its unit, as in \"3.5 um\"");
  if (!unit)
    throw DocumentedError(Trouble::unit, where, "unknown unit " + quoted(name), "use one of " + units_of(expected));
  return *unit;
}

}  // namespace

std::span<const Unit> unit_table() { return table; }

const Unit* find_unit(std::string_view name) {
  for (const Unit& unit : table)
    if (unit.name == name) return &unit;
  for (const auto& [spelling, plain] : spellings)
    if (spelling == name) return find_unit(plain);
  return nullptr;
}

std::string_view name_of(Dimension dimension) {
  switch (dimension) {
    case fraction:
      return "fraction";
    case time:
      return "time";
    case frequency:
      return "frequency";
    case length:
      return "length";
    case area:
      return "area";
    case volume:
      return "volume";
    case mass:
      return "mass";
    case density:
      return "density";
    case kinematic_viscosity:
      return "kinematic viscosity";
    case current:
      return "current";
    case voltage:
      return "voltage";
    case pressure:
      return "pressure";
    case force:
      return "force";
    case stiffness:
      return "stiffness";
    case flow:
      return "flow";
    case temperature:
      return "temperature";
    case percent_of_rated:
      return "percent of rated current";
    case percent_of_stroke:
      return "percent of spool stroke";
    case angle:
      return "angle";
    case level:
      return "level";
  }
  return "";
}

std::string units_of(Dimension dimension) {
  std::string list;
  for (const Unit& unit : table)
    if (unit.dimension == dimension) list += (list.empty() ? "" : ", ") + std::string(unit.name);
  return list;
}

std::optional<double> parse_number(std::string_view text) {
  const auto parts = split(text);
  if (!parts || !parts->rest.empty()) return std::nullopt;
  return parts->number;
}

Quantity parse_quantity(std::string_view text, Dimension expected, const Place& where) {
  const auto parts = split(text);
  if (!parts)
    throw InputError(
        where, quoted(text) + " is not a quantity",
        "write a number and a unit of " + std::string(name_of(expected)) + " (" + units_of(expected) + ")");
  if (parts->rest.empty() && expected != fraction)
    throw DocumentedError(Trouble::unit, where, quoted(text) + " has no unit", "add one of " + units_of(expected));
  const Unit& unit = unit_or_throw(parts->rest.empty() ? "-" : parts->rest, expected, where);
  if (unit.dimension != expected)
    throw DocumentedError(Trouble::unit, where,
                          quoted(unit.name) + " is a unit of " + std::string(name_of(unit.dimension)) + ", not of " +
                              std::string(name_of(expected)),
                          "use one of " + units_of(expected));
  const double si = unit.to_si(parts->number);
  if (!std::isfinite(si))
    throw InputError(where, quoted(text) + " is beyond 1.8e308 in SI", "write a quantity that something has");
  return {si, &unit};
}

Gain parse_gain(std::string_view text, Dimension expected, const Place& where) {
  const auto parts = split(text);
  const std::string mend = "write a number, or a number with a unit such as '20 " +
                           units_of(expected).substr(0, units_of(expected).find(',')) + "/V'";
  if (!parts) throw InputError(where, quoted(text) + " is not a gain", mend);
  if (parts->number == 0.0) throw InputError(where, "a gain of zero loses the signal", mend);
  if (parts->rest.empty()) return {parts->number, nullptr, nullptr};
  // The last '/' divides: "l/min/V" is (l/min)/V.
  const auto slash = parts->rest.rfind('/');
  if (slash == std::string_view::npos)
    throw InputError(where, quoted(text) + " is not a gain: its unit lacks '/'", mend);
  const Unit& numerator = unit_or_throw(trimmed(parts->rest.substr(0, slash)), expected, where);
  const Unit& denominator = unit_or_throw(trimmed(parts->rest.substr(slash + 1)), voltage, where);
  if (numerator.dimension != expected)
    throw DocumentedError(Trouble::unit, where,
                          quoted(numerator.name) + " is a unit of " + std::string(name_of(numerator.dimension)) +
                              ", not of " + std::string(name_of(expected)),
                          "use one of " + units_of(expected));
  const double gain = parts->number * numerator.multiply / numerator.divide / denominator.scale();
  if (!std::isfinite(gain) || gain == 0.0) throw InputError(where, quoted(text) + " is none or infinite in SI", mend);
  return {gain, &numerator, &denominator};
}

}  // namespace servodx
