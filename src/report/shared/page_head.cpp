#include "report/shared/page_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <utility>

#include "report/shared/handy.h"

namespace servodx::report {
namespace {

std::string word_of(const RigFile& rig, const std::string& key) {
  const auto at = rig.words.find(key);
  return at == rig.words.end() ? "" : at->second;
}

}  // namespace

void PageHead::say(const std::string& name, const std::string& value) {
  const auto at = std::find_if(facts.begin(), facts.end(), [&](const auto& fact) { return fact.first == name; });
  if (at != facts.end() && value.empty())
    facts.erase(at);
  else if (at != facts.end())
    at->second = value;
  else if (!value.empty())
    facts.emplace_back(name, value);
}

PageHead head_of(const RigFile& rig, std::string logo) {
  PageHead head;
  head.say("Rig", rig.name);
  head.say("Serial", rig.serial);
  head.say("Customer", word_of(rig, "page.customer"));
  head.say("Operator", word_of(rig, "page.operator"));
  head.say("Date", word_of(rig, "page.date"));
  if (rig.fluid.given)
    head.say("Fluid", !rig.fluid.name.empty()
                          ? rig.fluid.name
                          : fmt::format("{} mm2/s at 40 degC, {} kg/m3", digits(1e6 * rig.fluid.kinematic_viscosity),
                                        digits(rig.fluid.density, 4)));
  if (const auto supply = rig.fact("supply.pressure")) head.say("Rated supply", handy(*supply, "Pa"));
  std::istringstream lines(word_of(rig, "page.lines"));
  for (std::string line; std::getline(lines, line);) head.lines.push_back(line);
  head.logo = std::move(logo);
  return head;
}

}  // namespace servodx::report
