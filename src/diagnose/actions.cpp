#include "servodx/actions.h"

#include <toml++/toml.h>

#include <array>
#include <optional>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/key_error.h"
#include "base/nearest.h"
#include "base/reading_limits.h"
#include "base/toml_text.h"
#include "faults/fault.h"
#include "faults/registry.h"

namespace servodx {
namespace {

constexpr std::array<std::pair<const char*, ActionClass>, 4> classes = {{{"none", ActionClass::none},
                                                                         {"abuse", ActionClass::abuse},
                                                                         {"abnormal", ActionClass::abnormal},
                                                                         {"critical", ActionClass::critical}}};

// "critical: stop the machine"; empty without a class.
std::optional<Action> action_of(std::string text) {
  const std::size_t colon = text.find(':');
  if (colon == text.npos) return {};
  const std::string before = text.substr(0, colon);
  for (const auto& [name, of] : classes)
    if (before == name) return Action{of, std::move(text)};
  return {};
}

}  // namespace

Actions default_actions() {
  Actions out = {
      {"healthy", {ActionClass::none, "none: go on"}},
      {"unknown", {ActionClass::abnormal, "abnormal: call service"}},
      {misread_label, {ActionClass::abnormal, "abnormal: mend the rig file or the wiring, then diagnose again"}}};
  for (const Fault* fault : fault_list()) out[std::string(fault->name)] = *action_of(std::string(fault->action));
  return out;
}

Actions read_actions(const std::string& path) {
  const toml::table root = parse_toml(read_file_within(path, largest_toml), path,
                                      "write lines like clogged_filter = \"critical: stop the machine\"");
  Actions out = default_actions();
  std::vector<std::string> known;
  for (const auto& [label, action] : out) known.push_back(label);
  for (const auto& [name, node] : root) {
    const std::string label(name.str());
    const Place at{path, name.source().begin.line, label};
    if (!out.contains(label))
      throw key_error(at, "is no label", did_you_mean(label, known) + "'servodx list faults' has them");
    const std::optional<Action> action = action_of(node.value_or(std::string()));
    if (!action)
      throw key_error(at, "does not begin with a class of action",
                      "write \"critical: ...\", \"abnormal: ...\", \"abuse: ...\" or \"none: ...\"");
    out[label] = *action;
  }
  return out;
}

}  // namespace servodx
