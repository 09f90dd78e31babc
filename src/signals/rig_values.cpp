#include "signals/rig_values.h"

#include "base/nearest.h"
#include "base/trouble.h"

namespace servodx {
namespace {

std::string listed(std::initializer_list<std::string_view> words) {
  std::string list;
  for (auto word : words) list += (list.empty() ? "'" : ", '") + std::string(word) + "'";
  return list;
}

}  // namespace

Place RigValues::place(const std::string& key) const { return {rig_.path, rig_.line(key), key}; }

const toml::table& RigValues::section(const toml::node& node, const std::string& key) const {
  if (!node.is_table()) throw InputError(place(key), "is not a section", "write it as [" + key + "]");
  return *node.as_table();
}

std::string RigValues::word(const toml::node& node, const std::string& key) const {
  if (!node.is_string()) throw InputError(place(key), "is not a string", "put the value in quotes");
  return node.as_string()->get();
}

std::string RigValues::lines(const toml::node& node, const std::string& key) const {
  std::string all;
  const toml::array* texts = node.as_array();
  if (!texts) throw InputError(place(key), "is not a list", "write [\"first line\", \"second line\"]");
  for (const toml::node& text : *texts) {
    if (!all.empty()) all += '\n';
    all += word(text, key);
  }
  return all;
}

std::string RigValues::one_of(const toml::node& node, const std::string& key,
                              std::initializer_list<std::string_view> choices) const {
  const std::string choice = word(node, key);
  for (auto each : choices)
    if (each == choice) return choice;
  throw InputError(place(key), "unknown value '" + choice + "'",
                   did_you_mean(choice, choices) + "use one of " + listed(choices));
}

double RigValues::quantity(const toml::node& node, const std::string& key, Dimension dimension,
                           bool may_be_zero) const {
  const double value = signed_quantity(node, key, dimension);
  if (value < 0.0 || (value == 0.0 && !may_be_zero))
    throw InputError(place(key), may_be_zero ? "must not be negative" : "must be positive",
                     "check the sign, or leave the key out");
  return value;
}

double RigValues::signed_quantity(const toml::node& node, const std::string& key, Dimension dimension) const {
  if (node.is_number())
    throw DocumentedError(Trouble::unit, place(key), "a bare number has no unit",
                          "write a quoted quantity with one of " + units_of(dimension));
  return parse_quantity(word(node, key), dimension, place(key)).value;
}

std::string known_here(const std::string& word, const std::vector<std::string>& known) {
  std::vector<std::string> bare;
  std::string list;
  for (const std::string& each : known) {
    bare.push_back(each.front() == '[' ? each.substr(1, each.size() - 2) : each);
    list += (list.empty() ? "" : ", ") + each;
  }
  return did_you_mean(word, bare) + "known here: " + list;
}

}  // namespace servodx
