#include "explain/valve_causes.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "effects/effect.h"
#include "effects/row_effects.h"
#include "explain/constants.h"
#include "explain/sensor_causes.h"
#include "explain/subject.h"
#include "fit/chart.h"
#include "parameters/list.h"

namespace servodx {
namespace {

namespace k = explain_constants;

// A shape that was found in tuning is this valve's own: let go, it takes on what any other cause does, and held, it
// spoils the cause where tuning has it wrong. So it stays within its error. [unit] None: it was not found.
std::optional<double> error_from_tuning(const EffectParameter& p, const Table& table) {
  const int at = table.find(p.name);
  return at >= 0 && table[at].std_error > 0 ? table[at].std_error : std::nullopt;
}

// What switches an effect is its size; the others shape it.
CauseNumber size_of_effect(const EffectInfo& e, std::size_t j, const CauseFacts& facts) {
  const EffectParameter& p = e.parameters[j];
  CauseNumber out{effect_value(e, j, facts.tuned), p.unit};
  const double move = p.start - p.off, v = out.value.start, smaller = k::tried::smaller * move;
  out.sizes = sizes_within(out.value, {v + move, v + smaller, v + k::tried::larger * move, v + k::tried::largest * move,
                                       v - smaller, v - move});
  return out;
}
CauseNumber shape_of_effect(const EffectInfo& e, std::size_t j, const CauseFacts& facts) {
  const EffectParameter& p = e.parameters[j];
  CauseNumber out{effect_value(e, j, facts.tuned), p.unit, false};
  if (facts.table.find(p.name) < 0) out.value.start = p.start;
  if (out.value.start != p.start) out.typical = p.start;
  return out;
}

CauseNumber number_along(const RowAlong& along, const Table& table) {
  const Row& r = table[along.row];
  CauseNumber out{row_value(table, along.row), r.unit, along.grows};
  if (along.grows)
    out.sizes = sizes_within(out.value, {k::tried::along_a_little * r.nominal, k::tried::along_far * r.nominal});
  return out;
}

SoughtCause effect_cause(const EffectInfo& e, const CauseFacts& facts) {
  std::vector<CauseNumber> numbers;
  Cause cause = named(e.name, e.place, prior_of_effect(e, facts.rig_known));
  for (std::size_t j = 0; j < e.parameters.size(); ++j) {
    if (e.parameters[j].switches) {
      numbers.push_back(size_of_effect(e, j, facts));
      continue;
    }
    numbers.push_back(shape_of_effect(e, j, facts));
    if (const std::optional<double> error = error_from_tuning(e.parameters[j], facts.table)) {
      numbers.back().typical.reset();
      cause.ties.emplace_back(j, 0.0).push_back(1 / *error);
    }
  }
  if (e.along) numbers.push_back(number_along(*e.along, facts.table));
  cause.test = e.best_test;
  return sought(std::move(cause), numbers);
}

// Air belongs to a log's oil: the cause is a factor on each log's own.
CauseNumber factor_on_air(const Table& table) {
  constexpr int at = row::air_fraction;
  CauseNumber out{{std::string(parameter_list[at].name), at, k::tried::least_air, k::tried::most_air, true, 1.0},
                  table[at].unit};
  out.value.apply = [](double* candidate, double factor) { candidate[row::air_fraction] *= factor; };
  out.sizes.assign(std::begin(k::tried::air), std::end(k::tried::air));
  return out;
}

CauseNumber number_of_row(int at, const Table& table) {
  CauseNumber out{row_value(table, at), table[at].unit};
  out.sizes = sizes_of_row(out.value);
  return out;
}

SoughtCause row_effect_cause(const RowEffect& e, const CauseFacts& facts) {
  Cause cause = named(e.name, e.where);
  cause.of_channel = e.of_channel;
  cause.test = e.best_test;
  std::vector<CauseNumber> numbers;
  for (int at : e.rows) {
    const bool air = at == row::air_fraction;
    if (air) cause.atop = facts.table[at].name;
    CauseNumber& n = numbers.emplace_back(air ? factor_on_air(facts.table) : number_of_row(at, facts.table));
    if (e.worst) n.value.upper = std::max(n.value.upper, e.worst(facts.tuned.data()));
  }
  for (const int at : e.shapes) {
    const EffectParameter& p = parameter_at(at);
    const double start = facts.table.find(p.name) >= 0 ? facts.tuned[static_cast<std::size_t>(at)] : p.start;
    numbers.push_back({{p.name, at, p.lower, p.upper, true, start}, p.unit, false});
  }
  return sought(std::move(cause), numbers);
}

// A row that is tuned is let go of what tuning knows.
SoughtCause row_cause(int at, const Table& table) {
  return sought(named(table[at].name, std::string(parameter_list[static_cast<std::size_t>(at)].place), k::row_prior),
                {number_of_row(at, table)});
}

bool is_of_row_effect(int at) {
  return std::any_of(row_effects().begin(), row_effects().end(),
                     [&](const RowEffect& e) { return std::find(e.rows.begin(), e.rows.end(), at) != e.rows.end(); });
}

std::vector<SoughtCause> causes_of_effect(const EffectInfo& e, const CauseFacts& facts) {
  switch (sought_as(e, facts)) {
    case SoughtAs::whole:
      return {effect_cause(e, facts)};
    case SoughtAs::line_by_line:
      return mains_causes(e, facts);
    case SoughtAs::sensor_by_sensor:
      return sensor_causes(e, facts);
    case SoughtAs::meter_by_meter:
      return flow_meter_causes(e, facts);
    case SoughtAs::nothing:
      break;
  }
  return {};
}

}  // namespace

CauseFacts cause_facts(const std::vector<LogData>& logs, const Table& table, const ParameterVector& tuned,
                       const RigFile& rig, bool rig_known) {
  CauseFacts out{table, tuned, rig_known, rig.mains_frequency, logs.size(), {}, false, true, true, true};
  for (const LogData& l : logs) {
    for (const FitChannel& c : l.channels) out.compared.insert(c.signal);
    out.on_stand |= l.scenario.ports != Ports::actuator;
    out.oil_known &= l.scenario.oil_known;
    out.supply_measured &= !l.scenario.supply_pressure.empty();
    out.return_measured &= !l.scenario.return_pressure.empty();
  }
  return out;
}

SoughtAs sought_as(const EffectInfo& effect, const CauseFacts& facts) {
  if (effect.sought_as != SoughtAs::whole) return effect.sought_as;
  const bool told = !effect.shapes_rows && !effect.as_made && (facts.on_stand || !effect.stand_only) &&
                    (facts.oil_known || !effect.known_oil_only);
  return told ? SoughtAs::whole : SoughtAs::nothing;
}

double prior_of_effect(const EffectInfo& effect, bool rig_known) {
  return rig_known && effect.of_construction ? k::row_prior : 1.0;
}

bool is_sought_alone(int at, const CauseFacts& facts) {
  if (is_of_row_effect(at) || at == row::servovalve_null) return false;
  if (at == row::supply_pressure && facts.supply_measured) return false;
  if (at == row::return_pressure && facts.return_measured) return false;
  return facts.table[at].upper > facts.table[at].lower;
}

std::vector<SoughtCause> valve_causes(const CauseFacts& facts) {
  std::vector<SoughtCause> all;
  for (const EffectInfo& e : effect_list())
    for (SoughtCause& c : causes_of_effect(e, facts)) all.push_back(std::move(c));
  for (const RowEffect& e : row_effects()) all.push_back(row_effect_cause(e, facts));
  for (int at = 0; at < n_parameters; ++at)
    if (is_sought_alone(at, facts)) all.push_back(row_cause(at, facts.table));
  std::erase_if(all, [](const SoughtCause& c) { return c.cause.probes.empty(); });
  return all;
}

}  // namespace servodx
