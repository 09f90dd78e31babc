// The visible list of valve maps: one file and one line each.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"
#include "valve_maps/high_fidelity.h"

namespace servodx::valve_maps {

// Load pressure [Pa] from spool travel [m], load flow [m3/s] and supply less return [Pa].
using Map = std::function<double(double x_s, double q_j, double supply)>;

struct MapInfo {
  std::string name;
  std::string meaning;
  Map (*make)(const ValveNumbers& numbers, const HighFidelity& reference);
  Cost (*cost)(const ValveNumbers& numbers, const HighFidelity& reference);  // measured now
};
const std::vector<MapInfo>& map_list();

// Null where there is no such map.
const MapInfo* find_map(const std::string& name);

}  // namespace servodx::valve_maps
