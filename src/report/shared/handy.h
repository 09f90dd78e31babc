// Numbers as a person reads them: few digits, and a unit in which they are near one ("12 um", "41 %", "95 bar").
//
// Only for text; files carry SI or the log's own unit. A unit that the list does not know is kept.
#pragma once
#include <string>

#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::report {

// `significant` digits without an exponent between 1e-4 and 1e7; "-" where the value is not finite.
std::string digits(double value, int significant = 3);

struct HandyUnit {
  std::string name;     // "um", "% of rated current", "times the tuned friction"; empty for "-"
  double factor = 1.0;  // handy value per value in the unit given
};
// The unit that suits a value of this magnitude.
HandyUnit handy_unit(const std::string& unit, double magnitude);

std::string handy(double value, const std::string& unit);  // "12 um"
// "12 um (9 to 15, 95 %)"; the interval is left out where it is not finite.
std::string handy_interval(double value, double lower, double upper, const std::string& unit, int confidence = 95);

std::string plural(long n, const std::string& thing);  // "1 log", "2 logs"
std::string percent(double fraction);                  // "41 %", "0.03 %"
std::string chance(double probability);                // "41 %", "under 0.1 %"
std::string sentence(std::string words);               // begins with a capital, ends in a full stop
std::string duration(double seconds);                  // "0.42 s", "3 min 12 s"

// A channel's rms figures in the unit of the log; in SI where that unit is relative to a fact ('% of stroke').
struct ChannelFigures {
  std::string unit;
  double rms = 0, noise_rms = 0, heldout_rms = 0;  // [unit]
};
ChannelFigures figures(const ChannelResult& channel);

// "12 um +- 0.5" in the unit that suits the estimate.
struct InHandyUnit {
  explicit InHandyUnit(const ParameterResult& p);
  std::string operator()(double value, int significant = 4) const { return digits(value * unit.factor, significant); }
  HandyUnit unit;
};

}  // namespace servodx::report
