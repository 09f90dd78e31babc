#include "fit/ports_of.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "fit/log_gaps.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {

Ports ports_of(const Log& log, const RigFile& rig) {
  const bool has_actuator =
      log.has(Signal::piston_position) || (log.has(Signal::pressure_a) && log.has(Signal::pressure_b));
  const bool leakage = log.has(Signal::leakage_flow), flow = log.has(Signal::control_flow);
  if (rig.ports == Ports::actuator && has_actuator) return Ports::actuator;
  if (leakage != flow) return leakage ? Ports::blocked : Ports::free;
  // Free ports hold no load pressure.
  if (rig.ports == Ports::free && log.has(Signal::load_pressure) && !flow) return Ports::blocked;
  return rig.ports;
}

bool all_on_test_stand(const std::vector<Log>& logs, const RigFile& rig) {
  return std::all_of(logs.begin(), logs.end(), [&](const Log& l) { return ports_of(l, rig) != Ports::actuator; });
}

void take_valve_drop(Scenario& s, const Log& log, const RigFile& rig, std::vector<Note>& notes) {
  if (s.ports != Ports::free || !s.supply_pressure.empty()) return;
  const auto rated = rig.fact("valve.rated_pressure_drop");
  if (log.has(Signal::valve_pressure_drop)) {
    s.supply_pressure = bridged(log.time, log[Signal::valve_pressure_drop]);
  } else if (rated) {
    s.supply_pressure.assign(log.time.size(), *rated);
    notes.push_back(
        {Note::Kind::no_supply,
         log.path + ": no supply pressure is logged; the drop over the valve is valve.rated_pressure_drop"});
  } else {
    return;
  }
  const double table = rig.fact("supply.return_pressure").value_or(0.0);
  for (std::size_t k = 0; k < s.supply_pressure.size(); ++k)
    s.supply_pressure[k] += s.return_pressure.empty() ? table : s.return_pressure[k];
  if (s.return_pressure.empty()) s.return_pressure.assign(log.time.size(), table);
}

bool is_redundant(Signal which, const Log& log, Ports ports) {
  const bool pressures = log.has(Signal::pressure_a) && log.has(Signal::pressure_b);
  switch (which) {
    case Signal::load_pressure:
      return pressures || ports == Ports::free;
    case Signal::valve_pressure_drop:
      return pressures || log.has(Signal::load_pressure) || ports == Ports::free;
    case Signal::control_flow:
      return (log.has(Signal::flow_a) && log.has(Signal::flow_b)) || ports == Ports::blocked;
    case Signal::leakage_flow:
      return ports != Ports::blocked;  // by its definition
    default:
      return false;
  }
}

}  // namespace servodx
