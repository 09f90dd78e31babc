// The front door of valve maps.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <utility>

#include "base/celsius.h"
#include "base/require_setting.h"
#include "fit/oil_of.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/map.h"
#include "servodx/map_points.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/valve_numbers.h"
#include "valve_maps/compare_maps.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/papers_valve.h"
#include "valve_maps/registry.h"

namespace servodx {

using namespace valve_maps;

namespace {

ValveGeometry geometry_of(const Table& table, const Rig& rig) {
  const Oil oil = oil_of(rig.fluid, reference_oil_temperature);
  ValveGeometry g;
  g.port_width = table[row::port_width].nominal;
  g.radial_clearance = table[row::radial_clearance].nominal;
  g.lap_pa = table[row::lap_pa].nominal;
  g.lap_pb = table[row::lap_pb].nominal;
  g.lap_at = table[row::lap_at].nominal;
  g.lap_bt = table[row::lap_bt].nominal;
  g.density = oil.density;
  g.dynamic_viscosity = oil.dynamic_viscosity;
  g.return_pressure = table[row::return_pressure].nominal;
  return g;
}

}  // namespace

struct ValveMaps::Inside {
  HighFidelity reference;
  ValveNumbers numbers;
  double stop;  // [m]
};

ValveMaps::ValveMaps(const Table& table, const Rig& rig, bool as_paper) {
  ValveGeometry geometry = geometry_of(table, rig);
  double measured_at = table[row::supply_pressure].nominal - table[row::return_pressure].nominal;
  if (as_paper) {
    measured_at = papers_supply;
    geometry = overlapped_to(geometry, papers_leak_share, measured_at);
  }
  HighFidelity reference(geometry);
  const ValveNumbers numbers = reference.measure(measured_at);
  inside_ = std::make_shared<Inside>(Inside{reference, numbers, table[row::spool_stop].nominal});
}

const ValveNumbers& ValveMaps::numbers() const { return inside_->numbers; }

MapExtent ValveMaps::usual_extent() const {
  const ValveNumbers& valve = inside_->numbers;
  return {.travel = default_travel(valve), .flow = default_flow(valve), .supply = valve.supply};
}

std::vector<double> ValveMaps::falling_supplies(double supply) const {
  return valve_maps::falling_supplies(supply, inside_->numbers);
}

void MapExtent::validate() const {
  const auto is_positive = [](double x) { return std::isfinite(x) && x > 0; };
  require_setting(is_positive(travel), "--travel", "must be positive", "usual_extent() has the valve's own");
  require_setting(is_positive(flow), "--flow", "must be positive", "usual_extent() has the valve's own");
  require_setting(std::isfinite(supply), "--supply", "must be a number", "usual_extent() has the valve's own");
  for (const auto& [option, points] : {std::pair("MapExtent.travels", travels), std::pair("MapExtent.flows", flows)})
    require_setting(points >= 3 && points % 2 == 1, option, fmt::format("{} points do not meet zero", points),
                    "give an odd number, 3 or more");
}

std::vector<MapPoint> ValveMaps::points(const std::string& model, const MapExtent& extent) const {
  extent.validate();
  const MapInfo* info = find_map(model);
  require_setting(info, "--model", "there is no map '" + model + "'", "'servodx list models' has them");
  return grid(info->make(inside_->numbers, inside_->reference), extent.travel, extent.travels, extent.flow,
              extent.flows, extent.supply);
}

std::vector<MapError> ValveMaps::errors() const {
  return compare(inside_->numbers, inside_->reference, {.stop = inside_->stop});
}

}  // namespace servodx
