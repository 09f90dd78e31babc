#include "signals/signal.h"

namespace servodx {

using enum Dimension;

// clang-format off
const std::array<SignalInfo, n_signals> signal_list = {{
    {Signal::time,                "time",                "s",    time,        "time stamp; strictly increasing"},
    {Signal::command,             "command",             "A",    current,     "current demand before amplifier and null offset; positive extends the piston"},
    {Signal::coil_current,        "coil_current",        "A",    current,     "measured coil current; where present it drives the model behind the driver"},
    {Signal::setpoint,            "setpoint",            "m",    length,      "position demand of a closed loop; never the model's input"},
    {Signal::spool_position,      "spool_position",      "m",    length,      "spool travel; positive opens P to A and B to T"},
    {Signal::piston_position,     "piston_position",     "m",    length,      "from mid-stroke, rod relative to body; positive extends (A grows)"},
    {Signal::pressure_a,          "pressure_a",          "Pa",   pressure,    "chamber A, gauge"},
    {Signal::pressure_b,          "pressure_b",          "Pa",   pressure,    "chamber B, gauge"},
    {Signal::supply_pressure,     "supply_pressure",     "Pa",   pressure,    "at the valve's P port, gauge"},
    {Signal::return_pressure,     "return_pressure",     "Pa",   pressure,    "at the valve's T port, gauge"},
    {Signal::pilot_pressure_1,    "pilot_pressure_1",    "Pa",   pressure,    "spool end that pushes towards positive travel, gauge"},
    {Signal::pilot_pressure_2,    "pilot_pressure_2",    "Pa",   pressure,    "spool end that pushes towards negative travel, gauge"},
    {Signal::load_pressure,       "load_pressure",       "Pa",   pressure,    "pressure_a - pressure_b"},
    {Signal::valve_pressure_drop, "valve_pressure_drop", "Pa",   pressure,    "total over both metering edges"},
    {Signal::load_force,          "load_force",          "N",    force,       "external force; positive opposes extension"},
    {Signal::flow_a,              "flow_a",              "m3/s", flow,        "positive out of the valve into port A"},
    {Signal::flow_b,              "flow_b",              "m3/s", flow,        "positive out of the valve into port B"},
    {Signal::control_flow,        "control_flow",        "m3/s", flow,        "through the load, A to B; positive at positive command"},
    {Signal::leakage_flow,        "leakage_flow",        "m3/s", flow,        "supply to return, load ports blocked"},
    {Signal::oil_temperature,     "oil_temperature",     "K",    temperature, "oil at the valve"},
}};
// clang-format on

std::optional<Signal> find_signal(std::string_view name) {
  for (const SignalInfo& entry : signal_list)
    if (entry.name == name) return entry.signal;
  return std::nullopt;
}

std::string_view name_of(Signal s) { return info(s).name; }

std::optional<RelativeUnit> relative_unit(Signal s) {
  if (info(s).dimension == current) return RelativeUnit{percent_of_rated, "valve.rated_current"};
  if (s == Signal::spool_position) return RelativeUnit{percent_of_stroke, "valve.spool_stroke"};
  return std::nullopt;
}

std::string accepted_units(Signal s) {
  std::string list = units_of(info(s).dimension);
  if (const auto relative = relative_unit(s)) list += ", " + units_of(relative->dimension);
  if (s != Signal::time) list += ", or V with a gain in the rig file";
  return list;
}

}  // namespace servodx
