// Valve maps as a CSV file, a picture, text and JSON.
#pragma once
#include <string>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"

namespace servodx::report {

// spool_position [mm],load_flow [l/min],load_pressure [MPa]
std::string map_csv(const std::vector<valve_maps::MapPoint>& points);

struct MapPicture {
  std::string title;
  std::vector<valve_maps::MapPoint> points;         // of valve_maps::grid
  double supply = 0;                                // [Pa]
  std::vector<valve_maps::MapPoint> detailed = {};  // HF at the same places, to set beside it; may be empty
};
// Load pressure over spool position, a line for every few flows: the paper's Figs. 1b and 3.
std::string maps_svg(const std::vector<MapPicture>& pictures);

std::string text_of(const valve_maps::ValveNumbers& numbers, const std::vector<valve_maps::MapError>& errors);
// Without the costs: they are wall time, and a page is the same bytes for the same result.
Page maps_page(const Header& header, const valve_maps::ValveNumbers& numbers,
               const std::vector<valve_maps::MapError>& errors, const std::vector<MapPicture>& pictures);
Json maps_json(const valve_maps::ValveNumbers& numbers, const std::vector<valve_maps::MapError>& errors);

}  // namespace servodx::report
