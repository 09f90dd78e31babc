#include "report/map/valve_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/csv.h"
#include "base/units.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/line_chart.h"
#include "report/shared/replay_part.h"
#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"

namespace servodx::report {
namespace {

using valve_maps::MapError;
using valve_maps::MapPoint;
using valve_maps::ValveNumbers;

double in(const char* unit, double si) { return find_unit(unit)->from_si(si); }

constexpr int flows_drawn = 11;

}  // namespace

std::string map_csv(const std::vector<MapPoint>& points) {
  std::string out = "spool_position [mm],load_flow [l/min],load_pressure [MPa]\n";
  for (const MapPoint& p : points) {
    append_number(out, in("mm", p.x_s));
    out += ',';
    append_number(out, in("l/min", p.q_j));
    out += ',';
    append_number(out, in("MPa", p.load_pressure));
    out += '\n';
  }
  return out;
}

std::string maps_svg(const std::vector<MapPicture>& pictures) {
  // One scale for all: as the supply falls, what the map can hold shrinks and the water hammer stays.
  constexpr double shown = 2.0;  // of the supply: beyond, the water hammer leaves the picture
  double limit = 0;
  for (const MapPicture& picture : pictures) limit = std::max(limit, shown * in("MPa", picture.supply));
  std::vector<ChartPanel> panels;
  for (const MapPicture& picture : pictures) {
    ChartPanel panel{picture.title, "spool position [mm]", "load pressure P12 [MPa]", {}, {0, 0}, {0, 0}, false};
    panel.y_range = {-limit, limit};
    std::vector<double> flows;
    for (const MapPoint& p : picture.points)
      if (p.x_s == picture.points.front().x_s) flows.push_back(p.q_j);
    const std::size_t every = std::max<std::size_t>(1, (flows.size() - 1) / (flows_drawn - 1));
    for (std::size_t j = 0; j < flows.size(); j += every) {
      ChartLine line;
      if (j == 0 || j + every >= flows.size() || 2 * j + 1 == flows.size())
        line.label = "QJ " + digits(in("l/min", flows[j]), 3) + " l/min";
      for (std::size_t k = j; k < picture.points.size(); k += flows.size()) {
        line.x.push_back(in("mm", picture.points[k].x_s));
        line.y.push_back(in("MPa", picture.points[k].load_pressure));
      }
      panel.lines.push_back(std::move(line));
    }
    panels.push_back(std::move(panel));
  }
  return svg_of(panels, 2);
}

std::string text_of(const ValveNumbers& v, const std::vector<MapError>& errors) {
  Columns facts("lrll", 2);
  const auto row = [&](const char* name, double si, const char* unit, const char* meaning) {
    facts.row({name, digits(in(unit, si), 4), unit, meaning});
  };
  row("P_SR", v.supply, "bar", "supply less return");
  facts.row({"slope", digits(v.null_slope * 1e-11, 4), "bar/um", "of the load pressure at null, blocked ports"});
  facts.row({"G_P", digits(v.pressure_gain * 1e-11, 4), "bar/um", "pressure gain without leakage"});
  row("x_SS", v.saturation_travel, "um", "spool travel that saturates the pressure by that gain");
  facts.row({"G_Q", digits(v.flow_gain * 6e4 * 1e-3, 4), "l/min/mm", "flow gain"});
  row("C_LK P_SR", v.leakage * v.supply, "l/min", "null leakage of the spool");
  facts.row({"G_PQ C_LK", digits(v.leak_share(), 3), "-", "leakage against flow gain"});
  row("lap", v.lap, "um", "overlap, from the no-load flow");
  std::string text = "valve, measured on HF\n" + facts.text();

  text += "rms error against HF, % of P_SR, on a grid that the numbers were not read from; cost per evaluation\n";
  Columns table("l" + std::string(valve_maps::region_names.size() + 2, 'r'), 2);
  std::vector<std::string> head = {"model"}, points = {"points"};
  for (const char* name : valve_maps::region_names) head.push_back(words(name));
  head.insert(head.end(), {"ns in step", "ns in batch"});
  table.row(head);
  for (const MapError& e : errors) {
    std::vector<std::string> cells = {e.name};
    for (const valve_maps::RegionError& r : e.regions) cells.push_back(r.points ? digits(100 * r.rms, 3) : "-");
    cells.insert(cells.end(), {digits(e.cost.in_step * 1e9, 3), digits(e.cost.in_batch * 1e9, 3)});
    table.row(cells);
  }
  for (const valve_maps::RegionError& r : errors.front().regions) points.push_back(fmt::format("{}", r.points));
  table.row(points);
  return text + table.text() +
         "  linear, water hammer: near null, |xS| up to P_SR / slope; open, driven: beyond, driven above P_SR\n"
         "  in step: each evaluation waits for the one before, as in a simulation; in batch: independent points\n";
}

Json maps_json(const ValveNumbers& v, const std::vector<MapError>& errors) {
  Json models = Json::array();
  for (const MapError& e : errors) {
    Json regions = Json::object();
    for (std::size_t r = 0; r < e.regions.size(); ++r)
      regions[valve_maps::region_names[r]] = {
          {"points", e.regions[r].points}, {"rms", e.regions[r].rms}, {"largest", e.regions[r].largest}};
    models.push_back({{"name", e.name},
                      {"error_over_supply", regions},
                      {"cost_in_step", {{"value", e.cost.in_step}, {"unit", "s"}}},
                      {"cost_in_batch", {{"value", e.cost.in_batch}, {"unit", "s"}}}});
  }
  const auto value = [](double x, const char* unit) { return Json{{"value", x}, {"unit", unit}}; };
  return {{"valve",
           {{"supply_differential", value(v.supply, "Pa")},
            {"null_slope", value(v.null_slope, "Pa/m")},
            {"pressure_gain", value(v.pressure_gain, "Pa/m")},
            {"flow_gain", value(v.flow_gain, "m2/s")},
            {"gain_ratio", value(v.gain_ratio(), "Pa s/m3")},
            {"saturation_travel", value(v.saturation_travel, "m")},
            {"leakage", value(v.leakage, "m3/s/Pa")},
            {"null_leakage", value(v.null_leakage, "m3/s")},
            {"lap", value(v.lap, "m")},
            {"vapour_pressure", value(v.vapour_pressure, "Pa")}}},
          {"models", models}};
}

}  // namespace servodx::report
