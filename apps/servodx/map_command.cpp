// `servodx map --model NAME`: load pressure over spool position and load flow, and how near each map is to HF.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/units.h"
#include "commands.h"
#include "invocation.h"
#include "report/map/valve_maps.h"
#include "report/shared/columns.h"
#include "report/shared/json.h"
#include "servodx/data_sheet.h"
#include "servodx/lists.h"
#include "servodx/map.h"
#include "servodx/map_points.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string model, params = "params/borello2009.csv", output, svg;
  std::string supply, travel, flow;  // quantities; empty: from the valve
  bool paper = false;
};

double quantity_or(const std::string& text, const char* option, Dimension dimension, double otherwise) {
  if (text.empty()) return otherwise;
  const double value = parse_quantity(text, dimension, {option, 0, ""}).value;
  require_option(value > 0, option, "must be positive", "leave it out for the valve's own");
  return value;
}

void run(const Options& options) {
  std::vector<std::string> names;
  for (const ListedMap& map : listed_maps()) names.push_back(map.name);
  const bool all = options.model == "all";
  require_option(all || std::find(names.begin(), names.end(), options.model) != names.end(), "--model",
                 "there is no map '" + options.model + "'",
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

  const ValveMaps maps(table, rig, options.paper);
  MapExtent extent = maps.usual_extent();
  extent.supply = quantity_or(options.supply, "--supply", Dimension::pressure, extent.supply);
  extent.travel = quantity_or(options.travel, "--travel", Dimension::length, extent.travel);
  extent.flow = quantity_or(options.flow, "--flow", Dimension::flow, extent.flow);

  *invocation.header().settings = {
      {"model", options.model}, {"supply", extent.supply}, {"travel", extent.travel}, {"flow", extent.flow}};
  if (options.paper) (*invocation.header().settings)["paper"] = true;
  if (invocation.dry_run()) return;

  if (!options.output.empty()) write_file(options.output, report::map_csv(maps.points(options.model, extent)));
  std::vector<report::MapPicture> pictures;
  if (!options.svg.empty() || invocation.wants_report()) {
    for (const std::string& name : names)
      if (all) pictures.push_back({name, maps.points(name, extent), extent.supply});
    if (!all)
      for (const double at : maps.falling_supplies(extent.supply)) {
        MapExtent fallen = extent;
        fallen.supply = at;
        pictures.push_back({fmt::format("{}, P_SR {:.3g} bar", options.model, find_unit("bar")->from_si(at)),
                            maps.points(options.model, fallen), at});
      }
    if (!all && options.model != "HF") pictures.front().detailed = maps.points("HF", extent);
  }
  if (!options.svg.empty()) write_file(options.svg, report::maps_svg(pictures));

  const auto errors = maps.errors();
  if (invocation.wants_report())
    invocation.write_report(report::maps_page(invocation.header(), maps.numbers(), errors, pictures));
  report::Json body = report::maps_json(maps.numbers(), errors);
  body["output"] = options.output;
  body["picture"] = options.svg;
  invocation.finish(fmt::format("wrote {}\n", report::join(outputs)) + report::text_of(maps.numbers(), errors), body);
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
