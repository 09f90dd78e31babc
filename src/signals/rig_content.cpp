#include "signals/rig_content.h"

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
  add(rig.ports, rig.command_hold, rig.mains_frequency, rig.null_limit, rig.oil_temperature, rig.taps_at_cylinder,
      rig.facts, rig.words);
  Fluid fluid = rig.fluid;
  std::apply(add, fields(fluid));
  for (ResponseFact point : rig.response) std::apply(add, fields(point));
  return bytes;
}

}  // namespace servodx
