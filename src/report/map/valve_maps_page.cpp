#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "report/map/valve_maps.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"

namespace servodx::report {
namespace {

double in(const char* unit, double si) { return find_unit(unit)->from_si(si); }

// Percent; beyond ten times all a map is no use, however far.
Cell in_percent(double part) { return Cell(part > 10 ? "over 1000" : digits(100 * part), part); }

constexpr double shown = 2.0;  // of the supply: beyond, the water hammer leaves the picture

std::vector<double> flows_of(const std::vector<valve_maps::MapPoint>& points) {
  std::vector<double> flows;
  for (const auto& p : points)
    if (p.x_s == points.front().x_s) flows.push_back(p.q_j);
  return flows;
}

// Of one load flow, by its place among the flows: travel [um] and load pressure [bar].
std::vector<double> travel_of(const std::vector<valve_maps::MapPoint>& points, std::size_t flows) {
  std::vector<double> x;
  for (std::size_t k = 0; k < points.size(); k += flows) x.push_back(in("um", points[k].x_s));
  return x;
}
std::vector<double> pressure_of(const std::vector<valve_maps::MapPoint>& points, std::size_t flows, std::size_t j,
                                double supply) {
  std::vector<double> y;
  for (std::size_t k = j; k < points.size(); k += flows)
    y.push_back(std::abs(points[k].load_pressure) > shown * supply ? std::nan("") : in("bar", points[k].load_pressure));
  return y;
}

std::vector<Mark> supply_marks(double supply) { return {{in("bar", supply), "supply"}, {-in("bar", supply), ""}}; }

// Load pressure over travel at five load flows.
Plot plot_of(const MapPicture& picture) {
  const std::vector<double> flows = flows_of(picture.points);
  Plot plot{.title = picture.title + ": load pressure [bar]",
            .x_label = "spool position [um]",
            .x = travel_of(picture.points, flows.size()),
            .group = "maps"};
  constexpr Role roles[] = {Role::input, Role::other, Role::measured, Role::reference, Role::named};
  for (std::size_t i = 0; i < std::size(roles); ++i) {
    const std::size_t j = i * (flows.size() - 1) / (std::size(roles) - 1);
    plot.series.push_back({digits(in("l/min", flows[j])) + " l/min",
                           pressure_of(picture.points, flows.size(), j, picture.supply), roles[i]});
  }
  plot.y_marks = supply_marks(picture.supply);
  return plot;
}

// The map and HF at no load flow, half of the largest, and the largest; the other side is its mirror.
std::vector<Plot> beside_detailed(const std::string& model, const MapPicture& picture) {
  const std::vector<double> flows = flows_of(picture.points);
  std::vector<Plot> plots;
  for (const std::size_t quarters : {2, 3, 4}) {
    const std::size_t j = quarters * (flows.size() - 1) / 4;
    Plot plot{.title = "load flow " + digits(in("l/min", flows[j])) + " l/min: load pressure [bar]",
              .x_label = "spool position [um]",
              .x = travel_of(picture.points, flows.size()),
              .group = "maps"};
    plot.series = {{"HF", pressure_of(picture.detailed, flows.size(), j, picture.supply), Role::measured},
                   {model, pressure_of(picture.points, flows.size(), j, picture.supply), Role::named}};
    plot.y_marks = supply_marks(picture.supply);
    plots.push_back(std::move(plot));
  }
  return plots;
}

}  // namespace

Page maps_page(const Header& header, const valve_maps::ValveNumbers& valve,
               const std::vector<valve_maps::MapError>& errors, const std::vector<MapPicture>& pictures) {
  Page page(header, "Simplified valve models against HF");
  const auto worst_region = [](const valve_maps::MapError& e) {
    return static_cast<std::size_t>(std::max_element(e.regions.begin(), e.regions.end(),
                                                     [](const auto& x, const auto& y) { return x.rms < y.rms; }) -
                                    e.regions.begin());
  };
  const auto worst = [&](const valve_maps::MapError& e) { return e.regions[worst_region(e)].rms; };
  const auto where = [&](const valve_maps::MapError& e) {
    return percent(worst(e)) + " of the supply in its worst region (" +
           words(std::string(valve_maps::region_names[worst_region(e)])) + ")";
  };
  const valve_maps::MapError *best = nullptr, *asked = nullptr;
  const std::string model = header.settings->value("model", "");
  for (const auto& e : errors) {
    if (e.name != "HF" && (!best || worst(e) < worst(*best))) best = &e;
    if (e.name != "HF" && e.name == model) asked = &e;
  }
  Verdict v;
  v.headline = asked  ? "Map " + asked->name + " is off by " + where(*asked)
               : best ? "Nearest to the detailed model: " + best->name + ", off by " + where(*best)
                      : "Valve maps";
  v.detail =
      "Load pressure from spool position and load flow, against the detailed model HF: rms error, as a part of P_SR, "
      "supply less return.";
  if (asked && best) v.facts.push_back({"Nearest of all", best->name + ", " + percent(worst(*best))});
  v.facts.insert(v.facts.end(),
                 {{"Supply less return, P_SR", digits(in("bar", valve.supply), 4) + " bar"},
                  {"Travel at which it saturates, x_SS", digits(in("um", valve.saturation_travel), 3) + " um"},
                  {"Leakage share, G_PQ C_LK", digits(valve.leak_share(), 3)}});
  page.verdict(v);
  page.section("Error by region",
               "rms over the points of the region, in % of P_SR. Linear and water hammer: near null, within P_SR over "
               "the slope there. Saturated: from 90 % of P_SR to P_SR. Open: beyond null. Driven: the same, where the "
               "load drives the pressure beyond P_SR, as the water hammer does near null.");
  TablePart table{
      "Error against HF, % of P_SR", "l" + std::string(valve_maps::region_names.size() + 1, 'r'), {"map"}, {}, 0};
  for (const char* name : valve_maps::region_names) table.head.push_back(words(name));
  table.head.push_back("largest");
  for (const auto& e : errors) {
    std::vector<Cell> row = {e.name};
    double largest = 0;
    for (const auto& region : e.regions) {
      row.push_back(region.points > 0 ? in_percent(region.rms) : Cell(""));
      largest = std::max(largest, region.largest);
    }
    row.push_back(in_percent(largest));
    table.rows.push_back(std::move(row));
  }
  page.add(table);
  if (!pictures.empty() && !pictures.front().detailed.empty()) {
    page.section("Where " + model + " goes wrong", "Beside HF, at the supply asked for.");
    for (const Plot& plot : beside_detailed(model, pictures.front())) page.add(plot);
  }
  page.section("Maps", "Load pressure over spool position, a line for each load flow; cut at twice the supply.");
  for (const MapPicture& picture : pictures) page.add(plot_of(picture));
  return page;
}

}  // namespace servodx::report
