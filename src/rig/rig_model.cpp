#include "rig/rig_model.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>

#include "base/key_error.h"
#include "base/random.h"
#include "base/reading_limits.h"
#include "base/toml_text.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx::rig {
namespace {

constexpr const char* see_list = "see src/rig/parameters.inc for the list";

long line_of(const toml::node& node) { return static_cast<long>(node.source().begin.line); }

std::string key_of(const ParameterInfo& info) { return fmt::format("{}.{}", info.group, info.name); }

template <class E>
struct Word {
  const char* text;
  E value;
};
template <class E>
Word(const char*, E) -> Word<E>;  // clang 14 does not make it for an aggregate
constexpr std::array first_stages{Word{"flapper_nozzle", FirstStage::flapper_nozzle},
                                  Word{"jet_pipe", FirstStage::jet_pipe}};
constexpr std::array wirings{Word{"series", CoilWiring::series}, Word{"parallel", CoilWiring::parallel},
                             Word{"single", CoilWiring::single}};
constexpr std::array port_words{Word{"actuator", Ports::actuator}, Word{"blocked", Ports::blocked},
                                Word{"free", Ports::free}};

template <class E, std::size_t n>
E word(const std::array<Word<E>, n>& words, const std::string& text, const Place& where) {
  std::string known;
  for (const auto& w : words) {
    if (text == w.text) return w.value;
    known += (known.empty() ? "" : ", ") + std::string(w.text);
  }
  throw InputError(where, fmt::format("'{}' is not known", text), "known are " + known);
}

// True if `key` is one of the words that stand before the sections, and then sets it.
bool set_word(RigModel& model, const std::string& key, const std::string& text, const Place& where) {
  if (key == "first_stage") {
    model.first_stage = word(first_stages, text, where);
  } else if (key == "coil_wiring") {
    model.coil_wiring = word(wirings, text, where);
  } else if (key == "ports") {
    model.ports = word(port_words, text, where);
  } else {
    return false;
  }
  return true;
}

bool set_sensor_field(Sensor& sensor, const std::string& key, double value) {
  static const std::array<std::pair<const char*, double Sensor::*>, 6> fields{{{"gain", &Sensor::gain},
                                                                               {"offset", &Sensor::offset},
                                                                               {"lag", &Sensor::lag},
                                                                               {"noise", &Sensor::noise},
                                                                               {"pickup", &Sensor::pickup},
                                                                               {"quantum", &Sensor::quantum}}};
  for (const auto& [name, field] : fields) {
    if (key == name) {
      sensor.*field = value;
      return true;
    }
  }
  return false;
}
constexpr const char* sensor_fields = "known are unit, gain, offset, lag, noise, pickup, quantum and why";

void check_sensor(const Sensor& sensor, const Place& where) {
  if (sensor.lag < 0 || sensor.noise < 0 || sensor.quantum < 0 || sensor.pickup < 0) {
    throw InputError(where, "lag, noise, pickup and quantum are not negative", "correct the sign");
  }
}

// Groups that only some rigs have.
bool asked_for(const RigModel& m, std::string_view group) {
  if (group == "nozzles") return m.first_stage == FirstStage::flapper_nozzle;
  if (group == "jet_pipe") return m.first_stage == FirstStage::jet_pipe;
  if (group == "bench") return m.ports != Ports::actuator;
  return true;
}

// Reads one file over what its base has given.
class Reader {
 public:
  RigModel read(const std::string& path) {
    model_.spread.assign(rig_parameters().size(), 0.0);
    given_.assign(rig_parameters().size(), false);
    read_file(path, 0);
    model_.path = path;
    for (std::size_t i = 0; i < given_.size(); ++i) {
      const ParameterInfo& info = rig_parameters()[i];
      if (given_[i] || !asked_for(model_, info.group)) continue;
      throw InputError({path, 0, key_of(info)}, fmt::format("missing ({})", info.meaning),
                       fmt::format("add {} = {{ value = ..., unit = \"{}\", why = \"...\" }} under [{}]", info.name,
                                   info.unit, info.group));
    }
    // Columns keep the order of the canonical signal list, whatever the order in the file.
    std::sort(model_.sensors.begin(), model_.sensors.end(), [](const Sensor& a, const Sensor& b) {
      return index(*find_signal(a.signal)) < index(*find_signal(b.signal));
    });
    return std::move(model_);
  }

 private:
  void read_file(const std::string& path, int depth) {
    path_ = path;
    const toml::table root = parse_toml(read_file_within(path, largest_toml), path,
                                        "give a readable TOML file such as params/rigs/borello2009.toml");
    if (const toml::node* base = root.get("base")) {
      const Place where{path, line_of(*base), "base"};
      if (!base->is_string() || depth > 3) {
        throw InputError(where, "names no file, or bases stand on each other", "write base = \"borello2009.toml\"");
      }
      const auto folder = std::filesystem::path(path).parent_path();
      read_file((folder / base->value_or(std::string{})).string(), depth + 1);
      path_ = path;
    }
    model_.name = root["name"].value_or(model_.name.empty() ? std::string{"unnamed rig"} : model_.name);
    for (const auto& [key, node] : root) {
      const std::string name(key.str());
      if (name == "name" || name == "base") continue;
      const Place where{path, line_of(node), name};
      if (!node.is_table()) {
        if (set_word(model_, name, node.value_or(std::string{}), where)) continue;
        throw InputError(where, "unknown key",
                         "known before the sections are name, base, first_stage, coil_wiring, ports");
      }
      if (name == "sensors") {
        read_sensors(*node.as_table());
      } else {
        read_group(name, *node.as_table(), where);
      }
    }
  }

  void read_group(const std::string& group, const toml::table& entries, const Place& where) {
    const auto& list = rig_parameters();
    if (std::none_of(list.begin(), list.end(), [&](const ParameterInfo& p) { return group == p.group; })) {
      throw InputError(where, "unknown section", see_list);
    }
    for (const auto& [key, node] : entries) {
      const Place at{path_, line_of(node), group + "." + std::string(key.str())};
      const auto info =
          std::find_if(list.begin(), list.end(), [&](const ParameterInfo& p) { return key_of(p) == at.column; });
      if (info == list.end()) throw InputError(at, "unknown key", see_list);
      if (!node.is_table()) throw InputError(at, "not a table", "write { value = ..., unit = \"...\", why = \"...\" }");
      read_parameter(static_cast<std::size_t>(info - list.begin()), *node.as_table(), at);
    }
  }

  void read_parameter(std::size_t i, const toml::table& entry, const Place& where) {
    const ParameterInfo& info = rig_parameters()[i];
    for (const auto& [k, v] : entry) {
      if (k != "value" && k != "unit" && k != "why" && k != "spread") {
        throw InputError({path_, line_of(v), where.column}, fmt::format("unknown key '{}'", k.str()),
                         "known are value, unit, spread and why");
      }
    }
    const std::string unit = entry["unit"].value_or(std::string{});
    if (unit != info.unit) {
      throw InputError(where, fmt::format("unit '{}' is not '{}'", unit, info.unit), "convert the value to that unit");
    }
    if (entry["why"].value_or(std::string{}).empty()) {
      throw InputError(where, "no reason given", "say in 'why' where the value comes from");
    }
    model_.*info.field = number(entry, "value", where);
    check_bounds(info, model_.*info.field, where);
    model_.spread[i] = entry.contains("spread") ? number(entry, "spread", where) : 0.0;
    if (model_.spread[i] < 0.0) throw InputError(where, "the spread is negative", "correct the sign");
    given_[i] = true;
  }

  void read_sensors(const toml::table& entries) {
    for (const auto& [key, node] : entries) {
      const std::string name(key.str());
      const Place where{path_, line_of(node), "sensors." + name};
      if (!node.is_table()) throw InputError(where, "not a table", "write { unit = \"mm\", noise = ... }");
      if (!find_signal(name)) {
        throw InputError(where, "unknown signal", "use the canonical names of servodx list signals");
      }
      const toml::table& entry = *node.as_table();
      Sensor sensor{.signal = name, .unit = entry["unit"].value_or(std::string{})};
      if (!find_unit(sensor.unit)) {
        throw InputError(where, fmt::format("unknown unit '{}'", sensor.unit), "write unit = \"mm\" or the like");
      }
      for (const auto& [k, v] : entry) {
        const std::string field(k.str());
        if (field == "unit" || field == "why") continue;
        if (!set_sensor_field(sensor, field, number(entry, field.c_str(), where))) {
          throw InputError({path_, line_of(v), where.column}, fmt::format("unknown key '{}'", field), sensor_fields);
        }
      }
      check_sensor(sensor, where);
      std::erase_if(model_.sensors, [&](const Sensor& s) { return s.signal == name; });
      model_.sensors.push_back(sensor);
    }
  }

  static double number(const toml::table& entry, const char* key, const Place& where) {
    const auto value = entry[key].value<double>();
    if (!value || !std::isfinite(*value)) {
      throw InputError(where, fmt::format("'{}' is no finite number", key), "write it as a plain number");
    }
    return *value;
  }

  static void check_bounds(const ParameterInfo& info, double value, const Place& where) {
    if (value < info.low || value > info.high) {
      throw InputError(where, fmt::format("{} {} is outside {} to {}", value, info.unit, info.low, info.high),
                       "correct the value or its unit");
    }
  }

  std::string path_;
  RigModel model_;
  std::vector<bool> given_;
};

void check_whole(const RigModel& m) {
  const auto refuse = [&](const char* key, const char* rule, const char* mend) {
    throw InputError({m.path, 0, key}, rule, mend);
  };
  if (m.actuator_rod_a >= m.actuator_bore) refuse("actuator.rod_a", "rod not thinner than the bore", "swap them");
  if (m.actuator_rod_b >= m.actuator_bore) refuse("actuator.rod_b", "rod not thinner than the bore", "swap them");
  if (m.first_stage == FirstStage::flapper_nozzle && m.armature_stop >= m.nozzles_gap) {
    refuse("armature.stop", "the flapper would pass through a nozzle", "make it smaller than nozzles.gap");
  }
  if (m.first_stage == FirstStage::jet_pipe && m.jet_pipe_receiver_spacing < m.jet_pipe_receiver_diameter) {
    refuse("jet_pipe.receiver_spacing", "the receivers overlap", "make it larger than receiver_diameter");
  }
  if (m.ports != Ports::actuator && m.bench_volume <= 0.0) {
    refuse("bench", "the ports are blocked or free, and nothing is said of the bench", "add a section [bench]");
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

double RigModel::piston_area_a() const {
  return std::numbers::pi / 4 * (actuator_bore * actuator_bore - actuator_rod_a * actuator_rod_a);
}
double RigModel::piston_area_b() const {
  return std::numbers::pi / 4 * (actuator_bore * actuator_bore - actuator_rod_b * actuator_rod_b);
}
double RigModel::spool_area() const { return std::numbers::pi / 4 * spool_diameter * spool_diameter; }
double RigModel::working_turns() const { return coil_wiring == CoilWiring::series ? 2.0 * motor_turns : motor_turns; }
double RigModel::circuit_factor() const {
  return coil_wiring == CoilWiring::series ? 2.0 : coil_wiring == CoilWiring::parallel ? 0.5 : 1.0;
}

RigModel read_rig_model(const std::string& path) {
  try {
    RigModel model = Reader().read(path);
    check_whole(model);
    return model;
  } catch (const InputError& error) {
    throw_of_key(error);
  }
}

void set_value(RigModel& model, const std::string& text) {
  const auto equals = text.find('=');
  const std::string key = text.substr(0, equals);
  const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
  const Place where{"--set " + key, 0, ""};
  if (!set_word(model, key, value, where)) {
    const auto x = parse_number(value);
    if (!x) throw InputError(where, fmt::format("'{}' is no number", value), "write group.name=value in SI units");
    const auto& list = rig_parameters();
    const auto info = std::find_if(list.begin(), list.end(), [&](const ParameterInfo& p) { return key_of(p) == key; });
    if (info != list.end()) {
      if (*x < info->low || *x > info->high) {
        throw InputError(where, fmt::format("{} {} is outside {} to {}", *x, info->unit, info->low, info->high),
                         "give a value within");
      }
      model.*info->field = *x;
    } else {
      const auto dot = key.rfind('.');
      const auto sensor = std::find_if(model.sensors.begin(), model.sensors.end(),
                                       [&](const Sensor& s) { return "sensors." + s.signal == key.substr(0, dot); });
      if (sensor == model.sensors.end()) throw InputError(where, "unknown key", see_list);
      if (!set_sensor_field(*sensor, key.substr(dot + 1), *x)) throw InputError(where, "unknown key", sensor_fields);
      check_sensor(*sensor, where);
    }
  }
  check_whole(model);
  model.changed.push_back(text);
}

RigModel another_valve(const RigModel& model, std::uint64_t seed) {
  RigModel other = model;
  if (seed == 0) return other;
  const auto& list = rig_parameters();
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (model.spread[i] == 0.0) continue;
    Random random(seed, 90, static_cast<std::uint32_t>(i));
    const double deviation = std::clamp(random.normal(), -2.0, 2.0);
    double& value = other.*list[i].field;
    value = std::clamp(value + deviation * model.spread[i], list[i].low, list[i].high);
  }
  other.spool_breakaway = std::max(other.spool_breakaway, other.spool_coulomb);
  other.actuator_breakaway = std::max(other.actuator_breakaway, other.actuator_coulomb);
  if (other.first_stage == FirstStage::flapper_nozzle) {
    other.armature_stop = std::min(other.armature_stop, 0.95 * other.nozzles_gap);
  }
  other.name = fmt::format("{}, valve {}", model.name, seed);
  return other;
}

}  // namespace servodx::rig
