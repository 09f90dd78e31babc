// The values of a rig file's keys, read from TOML: a section, a word, one of several words, a quantity with its unit.
// What is not of the kind asked for is refused with file, line and key, and with the mend.
#pragma once
#include <toml++/toml.h>

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "servodx/rig.h"

namespace servodx {

class RigValues {
 public:
  // Whose path and lines stand in what is refused.
  explicit RigValues(const RigFile& rig) : rig_(rig) {}

  Place place(const std::string& key) const;
  const toml::table& section(const toml::node& node, const std::string& key) const;
  std::string word(const toml::node& node, const std::string& key) const;
  // Texts of an array, one a line.
  std::string lines(const toml::node& node, const std::string& key) const;
  std::string one_of(const toml::node& node, const std::string& key,
                     std::initializer_list<std::string_view> choices) const;
  // [SI] Not negative; zero where it may be.
  double quantity(const toml::node& node, const std::string& key, Dimension dimension, bool may_be_zero) const;
  double signed_quantity(const toml::node& node, const std::string& key, Dimension dimension) const;

 private:
  const RigFile& rig_;
};

// "did you mean 'pressure'? known here: pressure, return_pressure"; a section's brackets are no letters.
std::string known_here(const std::string& word, const std::vector<std::string>& known);

}  // namespace servodx
