#include "rig/rig_model.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "base/error.h"
#include "base/units.h"
#include "signals/signal.h"

namespace servodx::rig {
namespace {

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

double number(const toml::table& entry, const char* key, const Place& where) {
  const auto value = entry[key].value<double>();
  if (!value || !std::isfinite(*value)) {
    throw InputError(where, fmt::format("'{}' is no finite number", key), "write it as a plain number");
  }
  return *value;
}

void read_parameter(const ParameterInfo& info, const toml::table& root, RigModel& model) {
  const std::string key = fmt::format("{}.{}", info.group, info.name);
  const toml::node_view node = root[info.group][info.name];
  if (!node) {
    throw InputError({model.path, 0, key}, fmt::format("missing ({})", info.meaning),
                     fmt::format("add {} = {{ value = ..., unit = \"{}\", why = \"...\" }} under [{}]", info.name,
                                 info.unit, info.group));
  }
  const Place where{model.path, line_of(*node.node()), key};
  const toml::table* entry = node.as_table();
  if (!entry) throw InputError(where, "not a table", "write { value = ..., unit = \"...\", why = \"...\" }");
  for (const auto& [k, v] : *entry) {
    if (k != "value" && k != "unit" && k != "why") {
      throw InputError({model.path, line_of(v), key}, fmt::format("unknown key '{}'", k.str()),
                       "known are value, unit and why");
    }
  }
  const std::string unit = (*entry)["unit"].value_or(std::string{});
  if (unit != info.unit) {
    throw InputError(where, fmt::format("unit '{}' is not '{}'", unit, info.unit), "convert the value to that unit");
  }
  if ((*entry)["why"].value_or(std::string{}).empty()) {
    throw InputError(where, "no reason given", "say in 'why' where the value comes from");
  }
  const double value = number(*entry, "value", where);
  if (value < info.low || value > info.high) {
    throw InputError(where, fmt::format("{} {} is outside {} to {}", value, info.unit, info.low, info.high),
                     "correct the value or its unit");
  }
  model.*info.field = value;
}

void refuse_unknown(const toml::table& root, const std::string& path) {
  std::set<std::string> known, groups{"sensors"};
  for (const auto& info : rig_parameters()) {
    known.insert(fmt::format("{}.{}", info.group, info.name));
    groups.insert(info.group);
  }
  for (const auto& [group, node] : root) {
    const std::string name(group.str());
    if (name == "name") continue;
    if (!groups.contains(name)) {
      throw InputError({path, line_of(node), name}, "unknown section", "see src/rig/parameters.inc for the list");
    }
    if (name == "sensors") continue;
    if (!node.is_table()) throw InputError({path, line_of(node), name}, "not a section", "write [" + name + "]");
    for (const auto& [key, entry] : *node.as_table()) {
      const std::string full = fmt::format("{}.{}", name, key.str());
      if (!known.contains(full)) {
        throw InputError({path, line_of(entry), full}, "unknown key", "see src/rig/parameters.inc for the list");
      }
    }
  }
}

Sensor read_sensor(const std::string& signal, const toml::table& entry, const Place& where) {
  const auto known = find_signal(signal);
  if (!known) throw InputError(where, "unknown signal", "use the canonical names of servodx list signals");
  Sensor sensor{.signal = signal, .unit = entry["unit"].value_or(std::string{})};
  if (!find_unit(sensor.unit)) {
    throw InputError(where, fmt::format("unknown unit '{}'", sensor.unit), "write unit = \"mm\" or the like");
  }
  for (const auto& [k, v] : entry) {
    const std::string key(k.str());
    if (key == "unit" || key == "why") continue;
    const double value = number(entry, key.c_str(), where);
    if (key == "gain") {
      sensor.gain = value;
    } else if (key == "offset") {
      sensor.offset = value;
    } else if (key == "lag") {
      sensor.lag = value;
    } else if (key == "noise") {
      sensor.noise = value;
    } else if (key == "quantum") {
      sensor.quantum = value;
    } else {
      throw InputError({where.file, line_of(v), where.column}, fmt::format("unknown key '{}'", key),
                       "known are unit, gain, offset, lag, noise, quantum and why");
    }
  }
  if (sensor.lag < 0 || sensor.noise < 0 || sensor.quantum < 0) {
    throw InputError(where, "lag, noise and quantum are not negative", "correct the sign");
  }
  return sensor;
}

void check_whole(const RigModel& m) {
  const auto refuse = [&](const char* key, const char* rule, const char* mend) {
    throw InputError({m.path, 0, key}, rule, mend);
  };
  if (m.actuator_rod >= m.actuator_bore) refuse("actuator.rod", "rod not thinner than the bore", "swap them");
  if (m.armature_stop >= m.pilot_nozzle_gap) {
    refuse("armature.stop", "the flapper would pass through a nozzle", "make it smaller than pilot.nozzle_gap");
  }
  if (m.spool_stop < m.spool_stroke) refuse("spool.stop", "below the stroke", "make it at least spool.stroke");
  if (m.oil_viscosity_100 >= m.oil_viscosity_40) {
    refuse("oil.viscosity_100", "not below viscosity_40", "swap them");
  }
  if (m.spool_breakaway < m.spool_coulomb || m.actuator_breakaway < m.actuator_coulomb) {
    refuse("breakaway", "below the sliding friction", "swap breakaway and coulomb");
  }
}

}  // namespace

const std::vector<ParameterInfo>& rig_parameters() {
  static const std::vector<ParameterInfo> list{
#define RIG_PARAMETER(group, name, unit, low, high, meaning) \
  {#group, #name, unit, low, high, meaning, &RigModel::group##_##name},
#include "rig/parameters.inc"
#undef RIG_PARAMETER
  };
  return list;
}

double RigModel::piston_area() const {
  return std::numbers::pi / 4 * (actuator_bore * actuator_bore - actuator_rod * actuator_rod);
}
double RigModel::spool_area() const { return std::numbers::pi / 4 * spool_diameter * spool_diameter; }

RigModel read_rig_model(const std::string& path) {
  toml::table root;
  try {
    root = toml::parse_file(path);
  } catch (const toml::parse_error& e) {
    throw InputError({path, static_cast<long>(e.source().begin.line), ""}, std::string(e.description()),
                     "give a readable TOML file such as params/rigs/borello2009.toml");
  }
  RigModel model;
  model.path = path;
  model.name = root["name"].value_or(std::string{"unnamed rig"});
  refuse_unknown(root, path);
  for (const auto& info : rig_parameters()) read_parameter(info, root, model);
  // Columns keep the order of the canonical signal list, whatever the order in the file.
  if (const toml::table* sensors = root["sensors"].as_table()) {
    for (const auto& [key, node] : *sensors) {
      const Place where{path, line_of(node), "sensors." + std::string(key.str())};
      if (!node.is_table()) throw InputError(where, "not a table", "write { unit = \"mm\", noise = ... }");
      model.sensors.push_back(read_sensor(std::string(key.str()), *node.as_table(), where));
    }
  }
  std::sort(model.sensors.begin(), model.sensors.end(), [](const Sensor& a, const Sensor& b) {
    return index(*find_signal(a.signal)) < index(*find_signal(b.signal));
  });
  check_whole(model);
  return model;
}

}  // namespace servodx::rig
