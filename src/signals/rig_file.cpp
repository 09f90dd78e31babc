// The reader of rig.toml (servodx/rig.h): every key goes where it belongs, an unknown one is refused with its like.
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/csv.h"
#include "base/error.h"
#include "base/key_error.h"
#include "base/reading_limits.h"
#include "base/sha256.h"
#include "base/toml_text.h"
#include "base/trouble.h"
#include "base/two_pi.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/fittings.h"
#include "signals/oil_presets.h"
#include "signals/rig_agreement.h"
#include "signals/rig_columns.h"
#include "signals/rig_keys.h"
#include "signals/rig_values.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using enum Dimension;

// Ends of what a sheet may state of the dynamics: beyond 40 dB and a whole turn nothing of a valve can be read.
constexpr double most_decibels = 40;               // [dB]
constexpr double most_lag = two_pi;  // [rad]

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
    settle_facts(rig_);
    return std::move(rig_);
  }

 private:
  Place place(const std::string& key) const { return values_.place(key); }

  void walk(const toml::table& table, const std::string& prefix) {
    for (const auto& [name, node] : table) {
      const std::string key = prefix + std::string(name.str());
      rig_.lines[key] = name.source().begin.line;
      if (key == "columns") {
        read_columns(values_.section(node, key), rig_);
      } else if (key == "limits") {
        read_limits(values_.section(node, key));
      } else if (key == "fluid" && node.is_string()) {
        read_preset(values_.word(node, key));
      } else if (key == "valve.frequency_response") {
        read_response(node, key);
      } else if (key == "valve" || key == "actuator" || key == "lines" || key == "supply" || key == "fluid" ||
                 key == "valve.dither" || key == "page" || key == "measurement") {
        walk(values_.section(node, key), key + ".");
      } else {
        read_key(key, node);
      }
    }
  }

  void read_key(const std::string& key, const toml::node& node) {
    if (key == "name") {
      rig_.name = values_.word(node, key);
    } else if (key == "serial") {
      rig_.serial = values_.word(node, key);
    } else if (key == "ports") {
      const std::string choice = values_.one_of(node, key, {"actuator", "blocked", "free"});
      rig_.ports = choice == "blocked" ? Ports::blocked : choice == "free" ? Ports::free : Ports::actuator;
    } else if (key == "command_hold") {
      rig_.command_hold =
          values_.one_of(node, key, {"zero", "linear"}) == "linear" ? CommandHold::linear : CommandHold::zero;
    } else if (key == "mains_frequency") {
      rig_.mains_frequency = values_.quantity(node, key, frequency, false);
    } else if (key == "oil_temperature") {
      rig_.oil_temperature = values_.quantity(node, key, temperature, false);
    } else if (key == "null_limit") {
      rig_.null_limit = values_.quantity(node, key, fraction, true);
    } else if (key == "valve.first_stage") {
      rig_.words[key] = values_.one_of(node, key, {"flapper_nozzle", "jet_pipe"});
    } else if (key == "page.lines") {
      rig_.words[key] = values_.lines(node, key);
    } else if (is_page_word(key)) {
      rig_.words[key] = values_.word(node, key);
    } else if (key == "measurement.low_pass" && node.is_table()) {
      read_low_passes(*node.as_table(), key);
    } else if (key == "measurement.low_pass_order") {
      rig_.words[key] = values_.one_of(node, key, {"1", "2", "3", "4", "5", "6", "7", "8"});
    } else if (key == "lines.fittings") {
      read_fittings(node, key);
    } else if (key == "lines.taps") {
      rig_.taps = values_.one_of(node, key, {"valve", "cylinder"}) == "cylinder" ? Taps::at_cylinder : Taps::at_valve;
    } else {
      for (const RigFact& fact : rig_facts()) {
        if (fact.key != key) continue;
        rig_.facts[key] = values_.quantity(node, key, fact.dimension, fact.may_be_zero);
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
      const std::string name = values_.word(node, at);
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
        name = values_.word(field, of);
      else if (field_key == "source")
        source = values_.word(field, of);
      else if (field_key == "loss")
        loss = values_.quantity(field, of, fraction, true);
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
      rig_.facts[of] = values_.quantity(node, of, frequency, false);
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

  // One [[valve.frequency_response]] a point.
  void read_response(const toml::node& node, const std::string& key) {
    const toml::array* points = node.as_array();
    if (!points) throw InputError(place(key), "is not a list of points", "write each as [[" + key + "]]");
    for (const toml::node& point : *points) {
      const std::string at = key + "[" + std::to_string(rig_.response.size() + 1) + "]";
      rig_.lines[at] = point.source().begin.line;
      rig_.response.push_back(response_point(values_.section(point, at), at));
    }
  }

  ResponseFact response_point(const toml::table& table, const std::string& at) {
    ResponseFact fact;
    for (const auto& [name, node] : table) {
      const std::string field(name.str()), key = at + "." + field;
      rig_.lines[key] = name.source().begin.line;
      if (field == "frequency") {
        fact.frequency = values_.quantity(node, key, frequency, false);
      } else if (field == "amplitude") {
        fact.amplitude = values_.quantity(node, key, fraction, false);
        require_drivable(fact.amplitude, place(key));
      } else if (field == "gain") {
        fact.gain = values_.signed_quantity(node, key, level);
        if (std::abs(*fact.gain) > most_decibels)
          throw InputError(place(key), "is beyond 40 dB",
                           "give the gain over that at low frequency, such as \"-3 dB\"");
      } else if (field == "phase_lag") {
        fact.phase_lag = values_.quantity(node, key, angle, true);
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

  void read_preset(const std::string& name) {
    const Fluid* oil = find_oil(name);
    if (!oil)
      throw InputError(place("fluid"), "unknown fluid '" + name + "'",
                       "use one of " + names_of_oils() + ", or a [fluid] section with density and kinematic_viscosity");
    rig_.fluid = *oil;
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
        (known->upper ? limit.max : limit.min) = values_.quantity(node, key, known->dimension, true);
      } else {
        for (const auto& [side, bound] : *node.as_table()) {
          const std::string word(side.str()), at = key + "." + word;
          rig_.lines[at] = side.source().begin.line;
          if (word != "min" && word != "max")
            throw DocumentedError(Trouble::key, place(at), "unknown key", "known here: min, max");
          (word == "min" ? limit.min : limit.max) = values_.quantity(bound, at, known->dimension, true);
        }
        if (limit.min && limit.max && *limit.min > *limit.max)
          throw InputError(place(key), "min is above max", "swap them");
      }
      rig_.limits[figure] = limit;
    }
  }

  RigFile rig_;
  RigValues values_{rig_};
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
