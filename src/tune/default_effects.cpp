// What a tune frees unless told: the effects that the logs of such a rig can tell, as each effect states.
#include <algorithm>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/registry.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/ports_of.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "tune/constants.h"

namespace servodx {
namespace {

bool frees(const RigKind& kind, Freed freed) {
  switch (freed) {
    case Freed::never:
      return false;
    case Freed::everywhere:
      return true;
    case Freed::on_stands:
      return kind.on_stand;
    case Freed::on_actuators:
      return !kind.on_stand;
    case Freed::without_supply:
      return !kind.on_stand && !kind.supply_measured;
    case Freed::without_return:
      return !kind.on_stand && !kind.return_measured;
    case Freed::across_temperatures:
      return kind.temperatures_differ;
    case Freed::with_long_lines:
      return !kind.on_stand && kind.long_lines;
  }
  return false;
}

bool oils_differ(const std::vector<Log>& logs) {
  std::vector<double> known;  // [K]
  for (const Log& l : logs)
    if (const auto kelvin = measured_oil_temperature(l)) known.push_back(*kelvin);
  if (known.empty()) return false;
  const auto [coldest, hottest] = std::minmax_element(known.begin(), known.end());
  return *hottest - *coldest >= tune_constants::oils_apart;
}

}  // namespace

std::vector<std::string> default_effects(const RigKind& kind) {
  std::vector<std::string> out;
  for (const EffectInfo& e : effect_list())
    if (frees(kind, e.freed)) out.push_back(e.name);
  return out;
}

Table with_effects(const Table& table, const std::vector<std::string>& effects) {
  Table out = table;
  add_effect_rows(out, effects);
  return out;
}

RigKind rig_kind(const std::vector<Log>& logs, const RigFile& rig) {
  const auto all_hold = [&](Signal s) {
    return std::all_of(logs.begin(), logs.end(), [&](const Log& l) { return l.has(s); });
  };
  RigKind kind;
  kind.on_stand = all_on_test_stand(logs, rig);
  kind.supply_measured = all_hold(Signal::supply_pressure);
  kind.return_measured = all_hold(Signal::return_pressure);
  kind.temperatures_differ = oils_differ(logs);
  kind.long_lines = rig.fact("lines.length").value_or(0.0) >= tune_constants::long_line && rig.fact("lines.bore");
  return kind;
}

}  // namespace servodx
