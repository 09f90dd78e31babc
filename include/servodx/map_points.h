// Points of a valve map, and how far one is from the detailed one region by region.
#pragma once
#include <array>
#include <string>

namespace servodx::valve_maps {

struct MapPoint {
  double x_s, q_j, load_pressure;  // [m], [m3/s], [Pa]
};

// By what the detailed map says; src/valve_maps/compare.h has the bounds.
enum class Region { linear, saturated, water_hammer, open, driven };
inline constexpr std::array<const char*, 5> region_names = {"linear", "saturated", "water_hammer", "open", "driven"};

// [s] per evaluation. `in_step`: one after the other, the flow of each waiting for the pressure of the one before, as
// in a simulation; `in_batch`: independent points in a loop.
struct Cost {
  double in_step = 0, in_batch = 0;
};

struct RegionError {
  long points = 0;
  double rms = 0, largest = 0;  // [fraction of the P_SR of the point]
};

struct MapError {
  std::string name;
  std::array<RegionError, region_names.size()> regions;  // by Region
  Cost cost;                                             // zero where it was not asked for
};

}  // namespace servodx::valve_maps
