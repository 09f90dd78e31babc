// The canonical signals of a rig log: one list owns name, SI unit and sign convention (docs: contract, "Rig logs").
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "base/units.h"

namespace servodx {

enum class Signal : int {
  time,
  command,
  coil_current,
  setpoint,
  spool_position,
  piston_position,
  pressure_a,
  pressure_b,
  supply_pressure,
  return_pressure,
  pilot_pressure_1,
  pilot_pressure_2,
  load_pressure,
  valve_pressure_drop,
  load_force,
  flow_a,
  flow_b,
  control_flow,
  leakage_flow,
  oil_temperature,
};
inline constexpr int n_signals = 20;

struct SignalInfo {
  Signal signal;
  std::string_view name;
  std::string_view si_unit;  // unit inside
  Dimension dimension;
  std::string_view description;  // with sign convention
};

// Table in the order of the enum. Defined in signal.cpp.
extern const std::array<SignalInfo, n_signals> signal_list;

constexpr int index(Signal s) { return static_cast<int>(s); }
inline const SignalInfo& info(Signal s) { return signal_list[index(s)]; }
std::optional<Signal> find_signal(std::string_view name);

// The dimension of '% of ...' that the signal accepts, if any, and the rig-file fact that 100 % stands for.
struct RelativeUnit {
  Dimension dimension;
  std::string_view fact;
};
std::optional<RelativeUnit> relative_unit(Signal s);

// "A, mA, % of rated, or V with a gain in the rig file"
std::string accepted_units(Signal s);

}  // namespace servodx
