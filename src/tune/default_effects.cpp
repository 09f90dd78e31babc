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

// The quarter wave of oil at 1200 m/s is then 500 Hz: shorter lines answer above the band of logs of 1 kHz, and a fit
// would give their numbers to what else rings there. Chosen with rigs of 0.45, 0.68 and 1.08 m in view.
constexpr double long_line = 0.6;  // [m]

// Over this much the flattest and the steepest law of the usual oils differ by a factor of 1.3 in viscosity.
constexpr double apart = 20.0;  // [K]

bool oils_apart(const std::vector<Log>& logs) {
  std::vector<double> known;  // [K]
  for (const Log& l : logs)
    if (const auto kelvin = measured_oil_temperature(l)) known.push_back(*kelvin);
  if (known.empty()) return false;
  const auto [coldest, hottest] = std::minmax_element(known.begin(), known.end());
  return *hottest - *coldest >= apart;
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
  kind.temperatures_differ = oils_apart(logs);
  kind.long_lines = rig.fact("lines.length").value_or(0.0) >= long_line && rig.fact("lines.bore");
  return kind;
}

}  // namespace servodx
