// Map: load pressure over spool position and load flow, by simplified models of a table's valve and by the detailed
// one, HF, that they are judged by. docs/valve_maps.md.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "servodx/map_points.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/valve_numbers.h"

namespace servodx {

// How far a map goes: from -largest to +largest, evenly.
struct MapExtent {
  double travel = 0;             // [m] largest
  double flow = 0;               // [m3/s] largest
  double supply = 0;             // [Pa] less return
  int travels = 81, flows = 41;  // points; odd, so that zero is met

  // Throws InputError that names the option, as the program calls it.
  void validate() const;
};

// Copies are the same valve.
class ValveMaps {
 public:
  // `table`: facts of `rig` are in it (servodx/data_sheet.h); oil at 40 degC. `as_paper`: at the review's 20 MPa, edges
  // overlapped until G_PQ C_LK is its 0.2.
  ValveMaps(const Table& table, const Rig& rig, bool as_paper = false);

  const valve_maps::ValveNumbers& numbers() const;
  // What a picture shows unless told: the null region, the bend to saturation, and what a shut valve answers.
  MapExtent usual_extent() const;
  std::vector<double> falling_supplies(double supply) const;  // [Pa] from there down to the oil's vapour pressure

  // Rows of travel, columns of flow. `model`: one of listed_maps() (servodx/lists.h); InputError for another.
  std::vector<valve_maps::MapPoint> points(const std::string& model, const MapExtent& extent) const;
  // Of each model, up to the spool's stop, and what an evaluation costs on this machine now.
  std::vector<valve_maps::MapError> errors() const;

 private:
  struct Inside;
  std::shared_ptr<const Inside> inside_;
};

}  // namespace servodx
