#include "diagnose/load_sign.h"

#include <cstddef>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/flow_into_chambers.h"
#include "diagnose/motion.h"
#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace diagnose_constants::load_sign;

// What the pressures hold at each sample. [N]
std::vector<double> held_by(const std::vector<double>& a, const std::vector<double>& b, double area_a, double area_b) {
  std::vector<double> out(a.size());
  for (std::size_t k = 0; k < a.size(); ++k) out[k] = area_a * a[k] - area_b * b[k];
  return out;
}

}  // namespace

std::optional<Finding> load_against_pressures(const Log& log, const RigFile& rig, double rate) {
  for (const Signal s : {Signal::load_force, Signal::pressure_a, Signal::pressure_b})
    if (!log.has(s)) return {};
  const auto area_a = rig.fact("actuator.area_a"), area_b = rig.fact("actuator.area_b");
  if (!area_a || !area_b) return {};
  const std::vector<double> held = held_by(log[Signal::pressure_a], log[Signal::pressure_b], *area_a, *area_b);
  if (!(correlation(held, log[Signal::load_force]) < against)) return {};
  switch (chambers_by_flow(log, rig, rate)) {
    case Chambers::exchanged:
      return {};  // a finding of its own
    case Chambers::as_they_stand:
      return Finding{FindingKind::sign,
                     "'load_force' runs against the force of the pressures: positive is what opposes extension; give "
                     "its column gain = \"-1\" in the rig file",
                     {Signal::load_force}};
    case Chambers::not_told:
      return Finding{FindingKind::sign,
                     "'load_force' runs against the force of the pressures: its sign is turned (positive is what "
                     "opposes extension), or 'pressure_a' and 'pressure_b' are exchanged",
                     {Signal::load_force}};
  }
  return {};
}

}  // namespace servodx
