#include "prognose/valve_geometry.h"

#include "parameters/list.h"

namespace servodx {

valve_maps::ValveGeometry geometry_of(const ParameterVector& candidate, const Supply& at) {
  valve_maps::ValveGeometry g;
  g.port_width = candidate[row::port_width];
  g.radial_clearance = candidate[row::radial_clearance];
  g.lap_pa = candidate[row::lap_pa];
  g.lap_pb = candidate[row::lap_pb];
  g.lap_at = candidate[row::lap_at];
  g.lap_bt = candidate[row::lap_bt];
  g.density = at.oil.density;
  g.dynamic_viscosity = at.oil.dynamic_viscosity;
  g.return_pressure = at.return_;
  return g;
}

}  // namespace servodx
