#include "valve_maps/papers_valve.h"

#include "servodx/valve_numbers.h"

namespace servodx::valve_maps {

ValveGeometry overlapped_to(ValveGeometry geometry, double leak_share, double supply) {
  constexpr int halvings = 40;
  double low = 0, high = 20 * geometry.radial_clearance;  // the more overlap, the less leakage
  for (int i = 0; i < halvings; ++i) {
    const double lap = 0.5 * (low + high);
    geometry.lap_pa = geometry.lap_pb = geometry.lap_at = geometry.lap_bt = lap;
    (HighFidelity(geometry).measure(supply).leak_share() > leak_share ? low : high) = lap;
  }
  return geometry;
}

}  // namespace servodx::valve_maps
