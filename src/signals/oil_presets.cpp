#include "signals/oil_presets.h"

#include <array>
#include <string_view>

namespace servodx {
namespace {

struct OilPreset {
  Fluid fluid;
  std::array<std::string_view, 3> spellings;  // upper case, without blanks and dashes
};
// Without a viscosity at 100 degC: by the usual slope of such an oil.
const std::array<OilPreset, 5>& oil_presets() {
  static const std::array<OilPreset, 5> presets = {{
      {{870.0, 14e-6, 0, true, "MIL-PRF-5606"}, {"5606", "MILPRF5606", "MILH5606"}},
      {{840.0, 14.5e-6, 3.5e-6, true, "MIL-PRF-83282"}, {"83282", "MILPRF83282", "MILH83282"}},
      {{1010.0, 11e-6, 3.7e-6, true, "AS1241"}, {"AS1241", "SAEAS1241"}},
      {{868.0, 32e-6, 0, true, "ISO VG 32"}, {"ISOVG32", "VG32"}},
      {{873.0, 46e-6, 0, true, "ISO VG 46"}, {"ISOVG46", "VG46"}},
  }};
  return presets;
}

}  // namespace

const Fluid* find_oil(const std::string& name) {
  std::string spelling;
  for (char c : name)
    if (c != ' ' && c != '-' && c != '_') spelling += static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
  for (const OilPreset& preset : oil_presets())
    for (auto each : preset.spellings)
      if (!each.empty() && each == spelling) return &preset.fluid;
  return nullptr;
}

std::string names_of_oils() {
  std::string names;
  for (const OilPreset& preset : oil_presets()) names += (names.empty() ? "" : ", ") + preset.fluid.name;
  return names;
}

}  // namespace servodx
