#include "signals/rig_file.h"

#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>
#include <utility>

#include "base/csv.h"
#include "base/key_error.h"
#include "base/nearest.h"
#include "base/reading_limits.h"
#include "base/sha256.h"
#include "base/toml_text.h"
#include "base/trouble.h"
#include "base/two_pi.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "signals/fittings.h"

namespace servodx {
namespace {

using enum Dimension;

// Typical new oil; a [fluid] section overrides. Density [kg/m3] at 20 degC, viscosity [m2/s] at 40 and 100 degC.
// 5606, 83282: MIL-PRF-5606 (at least 13.2 mm2/s) and MIL-PRF-83282 (at least 14.0 mm2/s), makers' typical densities.
// AS1241: SAE AS1241 type IV phosphate ester, makers' typical values. ISO VG: ISO 3448 mid-point, typical mineral oil.
struct Preset {
  std::string_view name;
  std::string_view spellings[4];  // upper case, without blanks and dashes
  double density, kinematic_viscosity;
  double kinematic_viscosity_100 = 0;  // 0: by the usual slope of such an oil
};
constexpr Preset presets[] = {
    {"MIL-PRF-5606", {"5606", "MILPRF5606", "MILH5606"}, 870.0, 14e-6},
    {"MIL-PRF-83282", {"83282", "MILPRF83282", "MILH83282"}, 840.0, 14.5e-6, 3.5e-6},
    {"AS1241", {"AS1241", "SAEAS1241"}, 1010.0, 11e-6, 3.7e-6},
    {"ISO VG 32", {"ISOVG32", "VG32"}, 868.0, 32e-6},
    {"ISO VG 46", {"ISOVG46", "VG46"}, 873.0, 46e-6},
};

// Ends of what a sheet may state of the dynamics: amplifiers end at 1.5 times rated current; beyond 40 dB and a whole
// turn nothing of a valve can be read.
constexpr double most_amplitude = 1.5;  // [fraction of rated current]
constexpr double most_decibels = 40;    // [dB]
constexpr double most_lag = two_pi;     // [rad]

std::string listed(std::initializer_list<std::string_view> words) {
  std::string list;
  for (auto word : words) list += (list.empty() ? "'" : ", '") + std::string(word) + "'";
  return list;
}

// "did you mean 'pressure'? known here: pressure, return_pressure"; a section's brackets are no letters.
std::string known_here(const std::string& word, const std::vector<std::string>& known) {
  std::vector<std::string> bare;
  std::string list;
  for (const std::string& each : known) {
    bare.push_back(each.front() == '[' ? each.substr(1, each.size() - 2) : each);
    list += (list.empty() ? "" : ", ") + each;
  }
  return did_you_mean(word, bare) + "known here: " + list;
}

// What the head of a page says beside the rig, in words (report/page_head.h).
constexpr std::array<std::string_view, 5> page_words = {"logo", "lines", "customer", "operator", "date"};

bool is_page_word(std::string_view key) {
  constexpr std::string_view folder = "page.";
  return key.starts_with(folder) &&
         std::find(page_words.begin(), page_words.end(), key.substr(folder.size())) != page_words.end();
}

constexpr std::array not_simulated = {Signal::time,       Signal::command,         Signal::coil_current,
                                      Signal::setpoint,   Signal::supply_pressure, Signal::return_pressure,
                                      Signal::load_force, Signal::oil_temperature};

class Reader {
 public:
  explicit Reader(const std::string& path) { rig_.path = path; }

  RigFile read(const std::string& text) {
    text_ = text;
    rig_.sha256 = sha256(text);
    root_ = parse_toml(text, rig_.path, "mend the line; every value is a quoted string or a table");
    walk(root_, "");
    check_pairs();
    derive_areas();
    settle_fluid();
    return std::move(rig_);
  }

 private:
  Place place(const std::string& key) const { return {rig_.path, rig_.line(key), key}; }

  void walk(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      rig_.lines[key] = name.source().begin.line;
      if (key == "columns") {
        read_columns(section(node, key));
      } else if (key == "limits") {
        read_limits(section(node, key));
      } else if (key == "fluid" && node.is_string()) {
        read_preset(word(node, key));
      } else if (key == "valve.frequency_response") {
        read_response(node, key);
      } else if (key == "valve" || key == "actuator" || key == "lines" || key == "supply" || key == "fluid" ||
                 key == "valve.dither" || key == "page" || key == "measurement") {
        walk(section(node, key), key + ".");
      } else {
        read_key(key, node);
      }
    }
  }

  void read_key(const std::string& key, const toml::node& node) {
    if (key == "name") {
      rig_.name = word(node, key);
    } else if (key == "serial") {
      rig_.serial = word(node, key);
    } else if (key == "ports") {
      const std::string choice = one_of(node, key, {"actuator", "blocked", "free"});
      rig_.ports = choice == "blocked" ? Ports::blocked : choice == "free" ? Ports::free : Ports::actuator;
    } else if (key == "command_hold") {
      rig_.command_hold = one_of(node, key, {"zero", "linear"}) == "linear" ? CommandHold::linear : CommandHold::zero;
    } else if (key == "mains_frequency") {
      rig_.mains_frequency = quantity(node, key, frequency, false);
    } else if (key == "oil_temperature") {
      rig_.oil_temperature = quantity(node, key, temperature, false);
    } else if (key == "null_limit") {
      rig_.null_limit = quantity(node, key, fraction, true);
    } else if (key == "valve.first_stage") {
      rig_.words[key] = one_of(node, key, {"flapper_nozzle", "jet_pipe"});
    } else if (key == "page.lines") {
      rig_.words[key] = lines(node, key);
    } else if (is_page_word(key)) {
      rig_.words[key] = word(node, key);
    } else if (key == "measurement.low_pass" && node.is_table()) {
      read_low_passes(*node.as_table(), key);
    } else if (key == "measurement.low_pass_order") {
      rig_.words[key] = one_of(node, key, {"1", "2", "3", "4", "5", "6", "7", "8"});
    } else if (key == "lines.fittings") {
      read_fittings(node, key);
    } else if (key == "lines.taps") {
      rig_.taps = one_of(node, key, {"valve", "cylinder"}) == "cylinder" ? Taps::at_cylinder : Taps::at_valve;
    } else {
      for (const RigFact& fact : rig_facts()) {
        if (fact.key != key) continue;
        rig_.facts[key] = quantity(node, key, fact.dimension, fact.may_be_zero);
        return;
      }
      refuse_unknown(key);
    }
  }

  // Names of the list, or tables that state a loss of their own: all together are `lines.loss`, and what they are in
  // words.
  void read_fittings(const toml::node& node, const std::string& key) {
    const toml::array* list = node.as_array();
    if (!list)
      throw InputError(place(key), "is not a list", "write [\"entrance\", \"elbow_90\", \"elbow_90\", \"exit\"]");
    double loss = 0;
    int number = 0;
    std::string words;
    for (const toml::node& each : *list) {
      const std::string at = key + "[" + std::to_string(++number) + "]";
      rig_.lines[at] = each.source().begin.line;
      const auto [name, of_it] = fitting(each, at);
      loss += of_it;
      words += (words.empty() ? "" : ", ") + name;
    }
    rig_.facts["lines.loss"] = loss;
    rig_.words[key] = words;
  }

  std::pair<std::string, double> fitting(const toml::node& node, const std::string& at) {
    if (!node.is_table()) {
      const std::string name = word(node, at);
      std::vector<std::string> names;
      for (const Fitting& known : known_fittings) {
        if (known.name == name) return {name, known.loss};
        names.emplace_back(known.name);
      }
      throw InputError(place(at), "unknown fitting '" + name + "'",
                       known_here(name, names) + "; or give { name = \"...\", loss = \"0.8\", source = \"...\" }");
    }
    std::string name, source;
    std::optional<double> loss;
    for (const auto& [field_name, field] : *node.as_table()) {
      const std::string field_key(field_name.str()), of = at + "." + field_key;
      rig_.lines[of] = field_name.source().begin.line;
      if (field_key == "name")
        name = word(field, of);
      else if (field_key == "source")
        source = word(field, of);
      else if (field_key == "loss")
        loss = quantity(field, of, fraction, true);
      else
        throw DocumentedError(Trouble::key, place(of), "unknown key",
                              known_here(field_key, {"name", "loss", "source"}));
    }
    if (name.empty() || source.empty() || !loss)
      throw InputError(place(at), "states not name, loss and source",
                       "a loss coefficient without a source cannot be looked up: add all three");
    return {name + " (" + source + ")", *loss};
  }

  // Of each signal that is named.
  void read_low_passes(const toml::table& table, const std::string& key) {
    for (const auto& [name, node] : table) {
      const std::string signal(name.str()), of = key + "." + signal;
      rig_.lines[of] = name.source().begin.line;
      const auto found = find_signal(signal);
      if (!found) throw InputError(place(of), "'" + signal + "' is no signal", "take one of 'servodx list signals'");
      if (std::find(not_simulated.begin(), not_simulated.end(), *found) != not_simulated.end())
        throw InputError(place(of), "'" + signal + "' is not simulated: it drives the model as it was recorded",
                         "leave it out");
      rig_.facts[of] = quantity(node, of, frequency, false);
    }
  }

  // The last heading above a line that is still a comment, "# [valve]": its name, and its line.
  std::pair<std::string, long> heading_left_out(long below) const {
    std::pair<std::string, long> last;
    long number = 0;
    for (std::size_t at = 0; at < text_.size() && ++number < below;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      std::string line = text_.substr(at, end - at);
      at = end + 1;
      std::erase_if(line, [](char c) { return c == ' ' || c == '\t'; });
      const auto mark = line.find_first_not_of('#'), close = line.find(']');
      if (mark == line.npos || line[mark] != '[' || close == line.npos) continue;
      if (mark == 0)
        last = {};
      else
        last = {line.substr(mark + 1, close - mark - 1), number};
    }
    return last;
  }

  [[noreturn]] void refuse_unknown(const std::string& key) const {
    const auto dot = key.rfind('.');
    const auto [heading, line] = heading_left_out(rig_.line(key));
    for (const RigFact& fact : rig_facts())
      if (!heading.empty() && fact.key == heading + "." + key.substr(dot + 1))
        throw DocumentedError(
            Trouble::key, place(key),
            "belongs to [" + heading + "], whose heading in line " + std::to_string(line) + " is still a comment",
            "take the '#' off that line too");
    const std::string folder = dot == std::string::npos ? "" : key.substr(0, dot + 1);
    std::vector<std::string> known;
    if (folder.empty())
      known = {"name",       "serial",          "ports",   "command_hold", "mains_frequency",
               "null_limit", "oil_temperature", "fluid",   "[valve]",      "[actuator]",
               "[lines]",    "[supply]",        "[fluid]", "[limits]",     "[columns]",
               "[page]",     "[measurement]"};
    if (folder == "valve.") known = {"first_stage", "dither", "frequency_response"};
    if (folder == "lines.") known = {"taps", "fittings"};
    if (folder == "measurement.") known = {"low_pass_order"};
    if (folder == "page.") known.assign(page_words.begin(), page_words.end());
    for (const RigFact& fact : rig_facts())
      if (!folder.empty() && fact.key.starts_with(folder) && fact.key.find('.', folder.size()) == fact.key.npos)
        known.emplace_back(fact.key.substr(folder.size()));
    throw DocumentedError(Trouble::key, place(key), "unknown key", known_here(key.substr(folder.size()), known));
  }

  const toml::table& section(const toml::node& node, const std::string& key) const {
    if (!node.is_table()) throw InputError(place(key), "is not a section", "write it as [" + key + "]");
    return *node.as_table();
  }

  std::string word(const toml::node& node, const std::string& key) const {
    if (!node.is_string()) throw InputError(place(key), "is not a string", "put the value in quotes");
    return node.as_string()->get();
  }

  // Texts of an array, one a line.
  std::string lines(const toml::node& node, const std::string& key) const {
    std::string all;
    const toml::array* texts = node.as_array();
    if (!texts) throw InputError(place(key), "is not a list", "write [\"first line\", \"second line\"]");
    for (const toml::node& text : *texts) all += (all.empty() ? "" : "\n") + word(text, key);
    return all;
  }

  std::string one_of(const toml::node& node, const std::string& key,
                     std::initializer_list<std::string_view> choices) const {
    const std::string choice = word(node, key);
    for (auto each : choices)
      if (each == choice) return choice;
    throw InputError(place(key), "unknown value '" + choice + "'",
                     did_you_mean(choice, choices) + "use one of " + listed(choices));
  }

  double quantity(const toml::node& node, const std::string& key, Dimension dimension, bool may_be_zero) const {
    const double value = signed_quantity(node, key, dimension);
    if (value < 0.0 || (value == 0.0 && !may_be_zero))
      throw InputError(place(key), may_be_zero ? "must not be negative" : "must be positive",
                       "check the sign, or leave the key out");
    return value;
  }

  // One [[valve.frequency_response]] a point.
  void read_response(const toml::node& node, const std::string& key) {
    const toml::array* points = node.as_array();
    if (!points) throw InputError(place(key), "is not a list of points", "write each as [[" + key + "]]");
    for (const toml::node& point : *points) {
      const std::string at = key + "[" + std::to_string(rig_.response.size() + 1) + "]";
      rig_.lines[at] = point.source().begin.line;
      rig_.response.push_back(response_point(section(point, at), at));
    }
  }

  ResponseFact response_point(const toml::table& table, const std::string& at) {
    ResponseFact fact;
    for (const auto& [name, node] : table) {
      const std::string field(name.str()), key = at + "." + field;
      rig_.lines[key] = name.source().begin.line;
      if (field == "frequency") {
        fact.frequency = quantity(node, key, frequency, false);
      } else if (field == "amplitude") {
        fact.amplitude = quantity(node, key, fraction, false);
        require_drivable(fact.amplitude, key);
      } else if (field == "gain") {
        fact.gain = signed_quantity(node, key, level);
        if (std::abs(*fact.gain) > most_decibels)
          throw InputError(place(key), "is beyond 40 dB",
                           "give the gain over that at low frequency, such as \"-3 dB\"");
      } else if (field == "phase_lag") {
        fact.phase_lag = quantity(node, key, angle, true);
        if (*fact.phase_lag > most_lag)
          throw InputError(place(key), "is beyond 360 deg", "give the lag as a positive angle, such as \"90 deg\"");
      } else {
        throw DocumentedError(Trouble::key, place(key), "unknown key",
                              known_here(field, {"frequency", "amplitude", "gain", "phase_lag"}));
      }
    }
    if (fact.frequency == 0) throw InputError(place(at), "states no frequency", "add frequency = \"... Hz\"");
    if (!fact.gain && !fact.phase_lag)
      throw InputError(place(at), "states neither gain nor phase_lag", "add one of them, or leave the point out");
    return fact;
  }

  void require_drivable(double amplitude, const std::string& key) const {
    if (amplitude > most_amplitude)
      throw InputError(place(key), "is beyond 150 % of rated current, where amplifiers end",
                       "give the peak of the current as a part of rated, such as \"40 %\"");
  }

  double signed_quantity(const toml::node& node, const std::string& key, Dimension dimension) const {
    if (node.is_number())
      throw DocumentedError(Trouble::unit, place(key), "a bare number has no unit",
                            "write a quoted quantity with one of " + units_of(dimension));
    return parse_quantity(word(node, key), dimension, place(key)).value;
  }

  void read_preset(const std::string& name) {
    std::string spelling;
    for (char c : name)
      if (c != ' ' && c != '-' && c != '_') spelling += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    for (const Preset& preset : presets) {
      for (auto each : preset.spellings) {
        if (each.empty() || each != spelling) continue;
        rig_.fluid = {preset.density, preset.kinematic_viscosity, preset.kinematic_viscosity_100, true,
                      std::string(preset.name)};
        return;
      }
    }
    std::string known;
    for (const Preset& preset : presets) known += std::string(preset.name) + ", ";
    throw InputError(place("fluid"), "unknown fluid '" + name + "'",
                     "use one of " + known + "or a [fluid] section with density and kinematic_viscosity");
  }

  void read_limits(const toml::table& table) {
    for (const auto& [name, node] : table) {
      const std::string figure(name.str()), key = "limits." + figure;
      rig_.lines[key] = name.source().begin.line;
      const auto& list = limit_list();
      const auto known = std::find_if(list.begin(), list.end(), [&](const LimitInfo& l) { return l.figure == figure; });
      if (known == list.end()) {
        std::vector<std::string> names;
        for (const LimitInfo& l : list) names.emplace_back(l.figure);
        throw InputError(place(key), "unknown figure", known_here(figure, names));
      }
      Limit limit;
      if (!node.is_table()) {
        (known->upper ? limit.max : limit.min) = quantity(node, key, known->dimension, true);
      } else {
        for (const auto& [side, bound] : *node.as_table()) {
          const std::string word(side.str()), at = key + "." + word;
          rig_.lines[at] = side.source().begin.line;
          if (word != "min" && word != "max")
            throw DocumentedError(Trouble::key, place(at), "unknown key", "known here: min, max");
          (word == "min" ? limit.min : limit.max) = quantity(bound, at, known->dimension, true);
        }
        if (limit.min && limit.max && *limit.min > *limit.max)
          throw InputError(place(key), "min is above max", "swap them");
      }
      rig_.limits[figure] = limit;
    }
  }

  void read_columns(const toml::table& table) {
    for (const auto& [name, node] : table) {
      const std::string column(name.str());
      const std::string key = "columns." + column;
      rig_.lines[key] = name.source().begin.line;
      if (!node.is_table())
        throw InputError(place(key), "is not a mapping", "write { signal = \"...\", unit = \"...\" }");
      read_mapping(column, key, *node.as_table());
    }
  }

  void read_mapping(const std::string& column, const std::string& key, const toml::table& table) {
    ColumnMapping mapping;
    mapping.line = rig_.line(key);
    for (const auto& [name, node] : table) {
      const std::string field(name.str());
      rig_.lines[key + "." + field] = name.source().begin.line;
      if (field != "signal" && field != "unit" && field != "gain" && field != "offset")
        throw DocumentedError(Trouble::key, place(key + "." + field), "unknown key",
                              known_here(field, {"signal", "unit", "gain", "offset"}));
    }
    const toml::node* signal_node = table.get("signal");
    if (!signal_node) throw InputError(place(key), "names no signal", "add signal = \"...\"");
    mapping.signal = word(*signal_node, key + ".signal");
    const auto signal = find_signal(mapping.signal);
    if (!signal) {
      std::vector<std::string_view> names;
      for (const SignalInfo& each : signal_list) names.push_back(each.name);
      throw InputError(place(key + ".signal"), "unknown signal '" + mapping.signal + "'",
                       did_you_mean(mapping.signal, names) + "see 'servodx list signals'");
    }
    const Dimension dimension = info(*signal).dimension;

    if (const toml::node* node = table.get("gain")) {
      const Place where = place(key + ".gain");
      const Gain gain = node->is_number() ? parse_gain(number_text(*node->value<double>()), dimension, where)
                                          : parse_gain(word(*node, key + ".gain"), dimension, where);
      mapping.gain = gain.value;
      mapping.gain_has_unit = gain.numerator != nullptr;
      if (gain.numerator) {
        mapping.unit = gain.numerator->name;
        mapping.column_unit = gain.denominator->name;
      }
    }
    if (const toml::node* node = table.get("unit")) {
      const Place where = place(key + ".unit");
      const std::string name = word(*node, key + ".unit");
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
      mapping.offset = parse_quantity(word(*node, key + ".offset"), dimension, place(key + ".offset")).value;
    rig_.columns[column] = mapping;
  }

  static std::string number_text(double value) {
    std::string text;
    append_number(text, value);
    return text;
  }

  void check_pairs() const {
    const auto has = [&](const char* key) { return rig_.facts.contains(key); };
    if (has("valve.no_load_flow") && has("valve.rated_flow"))
      throw InputError(place("valve.rated_flow"), "given beside valve.no_load_flow", "keep one of the two");
    if (has("valve.rated_flow") && !has("valve.rated_pressure_drop"))
      throw InputError(place("valve.rated_flow"), "needs valve.rated_pressure_drop",
                       "add the total drop over both edges, such as rated_pressure_drop = \"70 bar\"");
    if (has("valve.rated_pressure_drop") && !has("valve.rated_flow"))
      throw InputError(place("valve.rated_pressure_drop"), "given without valve.rated_flow",
                       "add rated_flow or leave it out");
    if (has("valve.step_amplitude")) {
      if (!has("valve.step_rise_time"))
        throw InputError(place("valve.step_amplitude"), "given without valve.step_rise_time",
                         "add step_rise_time or leave it out");
      require_drivable(*rig_.fact("valve.step_amplitude"), "valve.step_amplitude");
    }
    if (has("supply.pressure") && has("supply.return_pressure") &&
        !(*rig_.fact("supply.return_pressure") < *rig_.fact("supply.pressure")))
      throw InputError(place("supply.return_pressure"), "is not below supply.pressure", "check both values");
  }

  void derive_areas() {
    const auto bore = rig_.fact("actuator.bore_diameter");
    for (const char side : {'a', 'b'}) {
      const std::string area_key = std::string("actuator.area_") + side;
      const std::string rod_key = std::string("actuator.rod_diameter_") + side;
      const auto rod = rig_.fact(rod_key);
      if (rod && !bore)
        throw InputError(place(rod_key), "needs actuator.bore_diameter", "add bore_diameter or give area_a and area_b");
      if (!bore) continue;
      if (rig_.fact(area_key))
        throw InputError(place(area_key), "given beside actuator.bore_diameter", "keep areas or diameters, not both");
      const double d = rod.value_or(0.0);
      if (d >= *bore) throw InputError(place(rod_key), "is not below actuator.bore_diameter", "check both diameters");
      rig_.facts[area_key] = std::numbers::pi / 4.0 * (*bore * *bore - d * d);
      rig_.lines[area_key] = rig_.line("actuator.bore_diameter");
    }
  }

  void settle_fluid() {
    const auto density = rig_.fact("fluid.density"), viscosity = rig_.fact("fluid.kinematic_viscosity");
    if (density) rig_.fluid.density = *density;
    if (viscosity) rig_.fluid.kinematic_viscosity = *viscosity;
    if (const auto hot = rig_.fact("fluid.kinematic_viscosity_100")) {
      if (*hot >= rig_.fluid.kinematic_viscosity)
        throw InputError(place("fluid.kinematic_viscosity_100"), "is not below the viscosity at 40 degC",
                         "give the viscosity at 100 degC, as the oil's sheet states it");
      rig_.fluid.kinematic_viscosity_100 = *hot;
    }
    rig_.fluid.given = rig_.fluid.given || density || viscosity;
    if (rig_.fluid.name.empty()) return;
    rig_.facts["fluid.density"] = rig_.fluid.density;
    rig_.facts["fluid.kinematic_viscosity"] = rig_.fluid.kinematic_viscosity;
    rig_.lines["fluid.density"] = rig_.lines["fluid.kinematic_viscosity"] = rig_.line("fluid");
  }

  RigFile rig_;
  std::string text_;
  toml::table root_;
};

// Columns that are still comments, with a question behind.
std::vector<long> open_questions(const std::string& text) {
  std::vector<long> out;
  std::istringstream lines(text);
  std::string line;
  for (long at = 1; std::getline(lines, line); ++at)
    if (line.starts_with("# \"") && line.find(asks_of_column) != std::string::npos) out.push_back(at);
  return out;
}

}  // namespace

const std::vector<RigFact>& rig_facts() {
  static const std::vector<RigFact> facts = {
      {"valve.rated_current", current, false},
      {"valve.dither.amplitude", current, true},
      {"valve.dither.frequency", frequency, false},
      {"valve.spool_stroke", length, false},
      {"valve.spool_stop", length, false},
      {"valve.spool_diameter", length, false},
      {"valve.land_length", length, false},
      {"valve.no_load_flow", flow, false},
      {"valve.rated_flow", flow, false},
      {"valve.rated_pressure_drop", pressure, false},
      {"valve.phase_lag_90_frequency", frequency, false},
      {"valve.step_rise_time", Dimension::time, false},
      {"valve.step_amplitude", fraction, false},
      {"valve.null_leakage", flow, true},
      {"valve.pilot_leakage", flow, true},
      {"valve.radial_clearance", length, false},
      {"valve.nozzle_diameter", length, false},
      {"valve.fixed_orifice_diameter", length, false},
      {"valve.nozzle_gap", length, false},
      {"valve.torque_motor_frequency", frequency, false},
      {"actuator.area_a", area, false},
      {"actuator.area_b", area, false},
      {"actuator.bore_diameter", length, false},
      {"actuator.rod_diameter_a", length, true},
      {"actuator.rod_diameter_b", length, true},
      {"actuator.stroke", length, false},
      {"actuator.moving_mass", mass, false},
      {"actuator.dead_volume_a", volume, false},
      {"actuator.dead_volume_b", volume, false},
      {"actuator.mount_stiffness", stiffness, false},
      {"lines.length", length, true},
      {"lines.bore", length, false},
      {"measurement.low_pass", frequency, false},
      {"supply.pressure", pressure, false},
      {"supply.return_pressure", pressure, true},
      {"fluid.density", density, false},
      {"fluid.kinematic_viscosity", kinematic_viscosity, false},
      {"fluid.kinematic_viscosity_100", kinematic_viscosity, false},
  };
  return facts;
}

const std::vector<LimitInfo>& limit_list() {
  static const std::vector<LimitInfo> list = {
      {"rated_flow", flow, false},
      {"null_bias", fraction, true},
      {"hysteresis", fraction, true},
      {"threshold", fraction, true},
      {"linearity", fraction, true},
      {"symmetry", fraction, true},
      {"lap", fraction, true},
      {"pressure_gain", fraction, false},
      {"null_leakage", flow, true},
      {"pilot_leakage", flow, true},
      {"phase_lag_90_frequency", frequency, false},
      {"amplitude_3db_frequency", frequency, false},
  };
  return list;
}

RigFile read_rig_file(const std::string& path) { return make_rig(path, read_file_within(path, largest_toml)); }

RigFile make_rig(const std::string& name, const std::string& text) {
  try {
    RigFile rig = Reader(name).read(text);
    rig.open_questions = open_questions(text);
    return rig;
  } catch (const InputError& error) {
    throw_of_key(error);  // quantities are read by who knows of columns only
  }
}

}  // namespace servodx
