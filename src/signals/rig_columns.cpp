#include "signals/rig_columns.h"

#include <string>
#include <string_view>
#include <vector>

#include "base/csv.h"
#include "base/error.h"
#include "base/nearest.h"
#include "base/trouble.h"
#include "base/units.h"
#include "servodx/log.h"
#include "signals/rig_values.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using enum Dimension;

std::string number_text(double value) {
  std::string text;
  append_number(text, value);
  return text;
}

void read_mapping(const std::string& column, const std::string& key, const toml::table& table, const RigValues& values,
                  RigFile& rig) {
  ColumnMapping mapping;
  mapping.line = rig.line(key);
  for (const auto& [name, node] : table) {
    const std::string field(name.str());
    rig.lines[key + "." + field] = name.source().begin.line;
    if (field != "signal" && field != "unit" && field != "gain" && field != "offset")
      throw DocumentedError(Trouble::key, values.place(key + "." + field), "unknown key",
                            known_here(field, {"signal", "unit", "gain", "offset"}));
  }
  const toml::node* signal_node = table.get("signal");
  if (!signal_node) throw InputError(values.place(key), "names no signal", "add signal = \"...\"");
  mapping.signal = values.word(*signal_node, key + ".signal");
  const auto signal = find_signal(mapping.signal);
  if (!signal) {
    std::vector<std::string_view> names;
    for (const SignalInfo& each : signal_list) names.push_back(each.name);
    throw InputError(values.place(key + ".signal"), "unknown signal '" + mapping.signal + "'",
                     did_you_mean(mapping.signal, names) + "see 'servodx list signals'");
  }
  const Dimension dimension = info(*signal).dimension;

  if (const toml::node* node = table.get("gain")) {
    const Place where = values.place(key + ".gain");
    const Gain gain = node->is_number() ? parse_gain(number_text(*node->value<double>()), dimension, where)
                                        : parse_gain(values.word(*node, key + ".gain"), dimension, where);
    mapping.gain = gain.value;
    mapping.gain_has_unit = gain.numerator != nullptr;
    if (gain.numerator) {
      mapping.unit = gain.numerator->name;
      mapping.column_unit = gain.denominator->name;
    }
  }
  if (const toml::node* node = table.get("unit")) {
    const Place where = values.place(key + ".unit");
    const std::string name = values.word(*node, key + ".unit");
    const Unit* unit = find_unit(name);
    if (!unit)
      throw DocumentedError(Trouble::unit, where, "unknown unit '" + name + "'",
                            "use one of " + accepted_units(*signal));
    const auto relative = relative_unit(*signal);
    if (mapping.gain_has_unit) {
      if (unit->dimension != find_unit(mapping.column_unit)->dimension)
        throw InputError(where, "'" + name + "' is not what the gain divides by ('" + mapping.column_unit + "')",
                         "make unit and gain agree");
    } else if (unit->dimension == voltage) {
      throw DocumentedError(Trouble::unit, where, "volts need a gain",
                            "add gain = \"... " + std::string(info(*signal).si_unit) + "/V\"");
    } else if (unit->dimension != dimension && !(relative && unit->dimension == relative->dimension)) {
      throw DocumentedError(Trouble::unit, where, "'" + name + "' is no unit of '" + mapping.signal + "'",
                            "use one of " + accepted_units(*signal));
    }
    mapping.column_unit = name;
  }
  if (const toml::node* node = table.get("offset"))
    mapping.offset =
        parse_quantity(values.word(*node, key + ".offset"), dimension, values.place(key + ".offset")).value;
  rig.columns[column] = mapping;
}

}  // namespace

void read_columns(const toml::table& table, RigFile& rig) {
  const RigValues values(rig);
  for (const auto& [name, node] : table) {
    const std::string column(name.str());
    const std::string key = "columns." + column;
    rig.lines[key] = name.source().begin.line;
    if (!node.is_table())
      throw InputError(values.place(key), "is not a mapping", "write { signal = \"...\", unit = \"...\" }");
    read_mapping(column, key, *node.as_table(), values, rig);
  }
}

}  // namespace servodx
