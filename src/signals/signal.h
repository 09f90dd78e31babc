// What is known of each canonical signal: made of the list in servodx/log.h, which owns name, SI unit, dimension and
// sign convention.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"
#include "servodx/log.h"

namespace servodx {

struct SignalInfo {
  Signal signal;
  std::string_view name;
  std::string_view si_unit;  // unit inside
  Dimension dimension;
  std::string_view description;  // with sign convention
};

// Table in the order of the enum. Defined in signal.cpp.
extern const std::array<SignalInfo, n_signals> signal_list;

inline const SignalInfo& info(Signal s) { return signal_list[index(s)]; }

// The dimension of '% of ...' that the signal accepts, if any, and the rig-file fact that 100 % stands for.
struct RelativeUnit {
  Dimension dimension;
  std::string_view fact;
};
std::optional<RelativeUnit> relative_unit(Signal s);

// "A, mA, % of rated, or V with a gain in the rig file"
std::string accepted_units(Signal s);

}  // namespace servodx
