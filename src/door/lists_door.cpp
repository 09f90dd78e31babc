// The front door of the registries.
#include <cstddef>

#include "effects/effect.h"
#include "effects/registry.h"
#include "effects/row_effects.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/lists.h"
#include "signals/signal.h"
#include "simulate/scenario.h"
#include "valve_maps/registry.h"

namespace servodx {

std::vector<ListedFault> listed_faults() {
  std::vector<ListedFault> out;
  for (const Fault* f : fault_list())
    out.push_back({std::string(f->name), std::string(f->unit), std::string(f->meaning), f->healthy, f->least, f->worst,
                   std::string(f->test), std::string(f->action)});
  return out;
}

std::vector<ListedEffect> listed_effects() {
  std::vector<ListedEffect> out;
  for (const EffectInfo& e : effect_list()) {
    ListedEffect& to = out.emplace_back(ListedEffect{e.name, e.place, e.meaning, false, {}});
    for (const EffectParameter& p : e.parameters)
      to.parameters.push_back({p.name, p.unit, p.meaning, 0, p.off, p.lower, p.upper, p.start});
  }
  for (const RowEffect& e : row_effects()) {
    ListedEffect& to = out.emplace_back(ListedEffect{e.name, e.where, e.meaning, true, {}});
    for (const int at : e.rows) {
      const ParameterInfo& p = parameter_list[static_cast<std::size_t>(at)];
      to.parameters.push_back(
          {std::string(p.name), std::string(p.unit), std::string(p.meaning), p.id, e.off, {}, {}, {}});
    }
    for (const int at : e.shapes) {
      const EffectParameter& p = parameter_at(at);
      to.parameters.push_back({p.name, p.unit, p.meaning, 0, p.off, {}, {}, {}});
    }
  }
  return out;
}

std::vector<ListedRow> listed_rows() {
  std::vector<ListedRow> out;
  for (const ParameterInfo& p : parameter_list)
    out.push_back(
        {p.id, std::string(p.name), std::string(name_of(p.group)), std::string(p.unit), std::string(p.meaning)});
  return out;
}

ListedModel identification_model() {
  return {"identification",
          "two-stage flapper-nozzle valve with feedback wire, lines and actuator; what logs are fitted with",
          n_base_states, n_parameters};
}

std::vector<ListedMap> listed_maps() {
  std::vector<ListedMap> out;
  for (const valve_maps::MapInfo& map : valve_maps::map_list()) out.push_back({map.name, map.meaning});
  return out;
}

std::vector<ListedSignal> listed_signals() {
  std::vector<ListedSignal> out;
  for (const SignalInfo& s : signal_list)
    out.push_back({s.signal, std::string(s.name), std::string(s.si_unit), accepted_units(s.signal),
                   std::string(s.description), simulated_index(s.signal) >= 0});
  return out;
}

}  // namespace servodx
