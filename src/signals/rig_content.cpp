#include "signals/rig_content.h"

#include <fmt/format.h>

#include <string_view>
#include <tuple>

#include "base/bytes.h"

namespace servodx {
namespace {

auto fields(ResponseFact& r) {
  auto& [frequency, amplitude, gain, phase_lag] = r;
  return std::tie(frequency, amplitude, gain, phase_lag);
}
auto fields(Fluid& f) {
  auto& [density, viscosity, viscosity_100, given, name] = f;
  return std::tie(density, viscosity, viscosity_100, given, name);
}

}  // namespace

std::string content_bytes(const RigFile& rig) {
  std::string bytes;
  const auto add = [&](const auto&... part) { (write_bytes(bytes, part), ...); };
  add(rig.ports, rig.command_hold, rig.mains_frequency, rig.null_limit, rig.oil_temperature, rig.taps, rig.facts,
      rig.words);
  Fluid fluid = rig.fluid;
  std::apply(add, fields(fluid));
  for (ResponseFact point : rig.response) std::apply(add, fields(point));
  return bytes;
}

RigStatements statements_of(const RigFile& rig) {
  constexpr std::string_view of_the_page = "page.";
  RigStatements out;
  const auto number = [&](const std::string& key, double value) { out[key] = fmt::format("{:.6g}", value); };
  for (const auto& [key, value] : rig.facts) number(key, value);
  for (const auto& [key, word] : rig.words)
    if (!key.starts_with(of_the_page)) out[key] = word;
  if (rig.ports != Ports::actuator) out["ports"] = rig.ports == Ports::blocked ? "blocked" : "free";
  if (rig.command_hold) out["command_hold"] = *rig.command_hold == CommandHold::linear ? "linear" : "zero";
  if (rig.taps != Taps::not_said) out["lines.taps"] = rig.taps == Taps::at_cylinder ? "cylinder" : "valve";
  if (rig.mains_frequency) number("mains_frequency", *rig.mains_frequency);
  if (rig.oil_temperature) number("oil_temperature", *rig.oil_temperature);
  number("null_limit", rig.null_limit);
  if (!rig.fluid.given) return out;
  number("fluid.density", rig.fluid.density);
  number("fluid.kinematic_viscosity", rig.fluid.kinematic_viscosity);
  if (rig.fluid.kinematic_viscosity_100 > 0) number("fluid.kinematic_viscosity_100", rig.fluid.kinematic_viscosity_100);
  return out;
}

}  // namespace servodx
