// `servodx map --model NAME`: load pressure over spool position and load flow, and how near each map is to HF.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/celsius.h"
#include "base/units.h"
#include "commands.h"
#include "fit/nominal.h"
#include "fit/oil_of.h"
#include "invocation.h"
#include "model/state.h"
#include "parameters/list.h"
#include "report/map/valve_maps.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "valve_maps/compare_maps.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/papers_valve.h"
#include "valve_maps/registry.h"
#include "valve_maps/valve_numbers.h"

namespace servodx {
namespace {

using namespace valve_maps;

constexpr int travels = 81, flows = 41;

struct Options {
  CommonOptions common;
  std::string model, params = "params/borello2009.csv", output, svg;
  std::string supply, travel, flow;  // quantities; empty: from the valve
  bool paper = false;
};

ValveGeometry geometry_of(const Table& table, const RigFile& rig) {
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

double quantity_or(const std::string& text, const char* option, Dimension dimension, double otherwise) {
  if (text.empty()) return otherwise;
  const double value = parse_quantity(text, dimension, {option, 0, ""}).value;
  require_option(value > 0, option, "must be positive", "leave it out for the valve's own");
  return value;
}

void run(const Options& options) {
  std::vector<std::string> names;
  for (const MapInfo& map : map_list()) names.push_back(map.name);
  const bool all = options.model == "all";
  require_option(all || find_map(options.model), "--model", "there is no map '" + options.model + "'",
                 "use one of " + report::join(names) + ", or all with --svg");
  require_option(!all || options.output.empty(), "--output", "holds one map", "name a model, or leave out -o");
  require_option(!options.output.empty() || !options.svg.empty() || !options.common.report.empty(), "--output",
                 "is missing", "add -o MAP.csv, or --svg FILE for a picture");
  Invocation invocation("map", options.common);
  std::vector<std::string> outputs;
  for (const std::string& path : {options.output, options.svg})
    if (!path.empty()) outputs.push_back(path);
  const std::string params = shipped_path(options.params);
  invocation.check_files({params}, outputs);
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(params), rig);

  ValveGeometry geometry = geometry_of(table, rig);
  double measured_at = table[row::supply_pressure].nominal - table[row::return_pressure].nominal;
  if (options.paper) {
    measured_at = papers_supply;
    geometry = overlapped_to(geometry, papers_leak_share, measured_at);
  }
  HighFidelity reference(geometry);
  const ValveNumbers valve = reference.measure(measured_at);
  const double supply = quantity_or(options.supply, "--supply", Dimension::pressure, valve.supply);
  const double travel = quantity_or(options.travel, "--travel", Dimension::length, default_travel(valve));
  const double flow = quantity_or(options.flow, "--flow", Dimension::flow, default_flow(valve));
  const auto map_of = [&](const MapInfo& info, double at) {
    return grid(info.make(valve, reference), travel, travels, flow, flows, at);
  };

  *invocation.header().settings = {{"model", options.model}, {"supply", supply}, {"travel", travel}, {"flow", flow}};
  if (options.paper) (*invocation.header().settings)["paper"] = true;
  if (invocation.dry_run()) return;

  if (!options.output.empty()) write_file(options.output, report::map_csv(map_of(*find_map(options.model), supply)));
  std::vector<report::MapPicture> pictures;
  if (!options.svg.empty() || invocation.wants_report()) {
    for (const MapInfo& info : map_list())
      if (all) pictures.push_back({info.name, map_of(info, supply), supply});
    if (!all)
      for (double at : falling_supplies(supply, valve))
        pictures.push_back({fmt::format("{}, P_SR {:.3g} bar", options.model, find_unit("bar")->from_si(at)),
                            map_of(*find_map(options.model), at), at});
    if (!all && options.model != "HF") pictures.front().detailed = map_of(*find_map("HF"), supply);
  }
  if (!options.svg.empty()) write_file(options.svg, report::maps_svg(pictures));

  const std::vector<MapError> errors = compare(valve, reference, {.stop = table[row::spool_stop].nominal});
  if (invocation.wants_report())
    invocation.write_report(report::maps_page(invocation.header(), valve, errors, pictures));
  report::Json body = report::maps_json(valve, errors);
  body["output"] = options.output;
  body["picture"] = options.svg;
  invocation.finish(fmt::format("wrote {}\n", report::join(outputs)) + report::text_of(valve, errors), body);
}

}  // namespace

void add_map_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("map", "Simplified valve models: maps, pictures, error against HF, cost");
  command->add_option("--model", options->model, "linear, A, C1, C2, C3, C5, bridge or HF; all: with --svg")
      ->required()
      ->type_name("NAME");
  command->add_option("--params", options->params, "table that holds the valve")->type_name("P")->capture_default_str();
  command->add_option("-o,--output", options->output, "the map")->type_name("MAP.csv");
  command->add_option("--svg", options->svg, "a picture: one model at falling supplies, or all at one")
      ->type_name("FILE.svg");
  command->add_flag("--paper", options->paper,
                    "the paper's numbers: 20 MPa, and edges overlapped until G_PQ C_LK is 0.2");
  command->add_option("--supply", options->supply, "supply less return, '100 bar'; the table's unless told")
      ->type_name("P");
  command->add_option("--travel", options->travel, "largest spool position, '50 um'; 5 x_SS unless told")
      ->type_name("X");
  command->add_option("--flow", options->flow, "largest load flow, '1 l/min'; 2 G_Q x_SS unless told")->type_name("Q");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
