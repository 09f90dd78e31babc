#include <algorithm>
#include <cmath>

#include "base/units.h"
#include "report/columns.h"
#include "report/handy.h"
#include "report/replay_part.h"
#include "report/valve_maps.h"

namespace servodx::report {
namespace {

double in(const char* unit, double si) { return find_unit(unit)->from_si(si); }

constexpr double shown = 2.0;  // of the supply: beyond, the water hammer leaves the picture

// Load pressure over travel at five load flows.
Plot plot_of(const MapPicture& picture) {
  Plot plot{.title = picture.title + ": load pressure [MPa]", .x_label = "spool position [um]", .group = "maps"};
  std::vector<double> flows;
  for (const auto& p : picture.points) {
    if (p.x_s == picture.points.front().x_s) flows.push_back(p.q_j);
    if (plot.x.empty() || plot.x.back() != in("um", p.x_s)) plot.x.push_back(in("um", p.x_s));
  }
  constexpr Role roles[] = {Role::input, Role::other, Role::measured, Role::reference, Role::named};
  const double limit = shown * in("MPa", picture.supply);
  for (std::size_t i = 0; i < std::size(roles); ++i) {
    const std::size_t j = i * (flows.size() - 1) / (std::size(roles) - 1);
    Series series{digits(in("l/min", flows[j])) + " l/min", {}, roles[i]};
    for (std::size_t k = j; k < picture.points.size(); k += flows.size()) {
      const double p = in("MPa", picture.points[k].load_pressure);
      series.y.push_back(std::abs(p) > limit ? std::nan("") : p);
    }
    plot.series.push_back(std::move(series));
  }
  plot.y_marks = {{in("MPa", picture.supply), "supply"}, {-in("MPa", picture.supply), ""}};
  return plot;
}

}  // namespace

Page maps_page(const Header& header, const valve_maps::ValveNumbers& valve,
               const std::vector<valve_maps::MapError>& errors, const std::vector<MapPicture>& pictures) {
  Page page(header, "Simplified valve models against HF");
  const auto worst = [](const valve_maps::MapError& e) {
    double rms = 0;
    for (const auto& region : e.regions) rms = std::max(rms, region.rms);
    return rms;
  };
  const valve_maps::MapError *best = nullptr, *asked = nullptr;
  const std::string model = header.settings.value("model", "");
  for (const auto& e : errors) {
    if (e.name != "HF" && (!best || worst(e) < worst(*best))) best = &e;
    if (e.name != "HF" && e.name == model) asked = &e;
  }
  Verdict v;
  v.headline = asked  ? "Map " + asked->name + " is wrong by up to " + percent(worst(*asked)) + " of the supply"
               : best ? "Nearest to the detailed model: " + best->name + ", wrong by up to " + percent(worst(*best)) +
                            " of the supply"
                      : "Valve maps";
  v.detail =
      "Load pressure from spool position and load flow, against the detailed model HF: rms in the worst of four "
      "regions, "
      "as a part of P_SR, supply less return.";
  if (asked && best) v.facts.push_back({"Nearest of all", best->name + ", " + percent(worst(*best))});
  v.facts.insert(v.facts.end(),
                 {{"Supply less return, P_SR", digits(in("bar", valve.supply), 4) + " bar"},
                  {"Travel at which it saturates, x_SS", digits(in("um", valve.saturation_travel), 3) + " um"},
                  {"Leakage share, G_PQ C_LK", digits(valve.leak_share(), 3)}});
  page.verdict(v);
  page.section("Error by region",
               "rms over the points of the region, in % of P_SR. Water hammer: beyond the supply. Saturated: above 90 "
               "% of it. Null: "
               "within x_SS. Linear: the rest.");
  TablePart table{"Error against HF, % of P_SR", "lrrrrr", {"map"}, {}, 0};
  for (const char* name : valve_maps::region_names) table.head.push_back(words(name));
  table.head.push_back("largest");
  for (const auto& e : errors) {
    std::vector<Cell> row = {e.name};
    double largest = 0;
    for (const auto& region : e.regions) {
      row.push_back(region.points > 0 ? Cell(digits(100 * region.rms), region.rms) : Cell(""));
      largest = std::max(largest, region.largest);
    }
    row.push_back(Cell(digits(100 * largest), largest));
    table.rows.push_back(std::move(row));
  }
  page.add(table);
  page.section("Maps", "Load pressure over spool position, a line for each load flow; cut at twice the supply.");
  for (const MapPicture& picture : pictures) page.add(plot_of(picture));
  return page;
}

}  // namespace servodx::report
