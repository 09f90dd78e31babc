#include "signals/signal.h"

namespace servodx {

using enum Dimension;

const std::array<SignalInfo, n_signals> signal_list = {{
#define X(name, unit, dimension, meaning) {Signal::name, #name, unit, Dimension::dimension, meaning},
    SERVODX_SIGNALS(X)
#undef X
}};

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
