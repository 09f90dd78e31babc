#include "diagnose/load_sign.h"

#include <cmath>
#include <cstddef>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/flow_into_chambers.h"
#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace diagnose_constants::load_sign;

struct Moments {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  void add(double a, double b) { ++n, x += a, y += b, xx += a * a, yy += b * b, xy += a * b; }
  double spread_x() const { return xx - x * x / n; }
  double spread_y() const { return yy - y * y / n; }
  double correlation() const { return (xy - x * y / n) / std::sqrt(spread_x() * spread_y()); }
};

}  // namespace

std::optional<Finding> load_against_pressures(const Log& log, const RigFile& rig, double rate) {
  for (const Signal s : {Signal::load_force, Signal::pressure_a, Signal::pressure_b})
    if (!log.has(s)) return {};
  const auto area_a = rig.fact("actuator.area_a"), area_b = rig.fact("actuator.area_b");
  if (!area_a || !area_b) return {};
  const std::vector<double>&a = log[Signal::pressure_a], &b = log[Signal::pressure_b], &load = log[Signal::load_force];
  Moments m;
  for (std::size_t k = 0; k < load.size(); ++k)
    if (const double held = *area_a * a[k] - *area_b * b[k]; std::isfinite(held) && std::isfinite(load[k]))
      m.add(held, load[k]);
  if (m.n < fewest || !(m.spread_y() > much_of_force * m.spread_x()) || !(m.correlation() < against)) return {};
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
