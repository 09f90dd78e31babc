// `servodx simulate LOG`: the model driven by the log's inputs; writes the log's measured signals, simulated.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "commands.h"
#include "invocation.h"
#include "report/shared/columns.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/simulate/simulate_page.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/pages.h"
#include "servodx/rig.h"
#include "servodx/simulate.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, output;
  std::optional<double> step;  // [s]
  bool reference = false;
};

void run(const Options& options) {
  const SimulationOptions how{.step = options.step, .reference = options.reference, .threads = options.common.threads};
  how.validate();
  Invocation invocation("simulate", options.common);
  invocation.check_files({options.log, options.params}, {options.output});
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(options.params), rig);
  const Log log = invocation.log(options.log, rig);
  report::add_to_head(invocation.header().head, {log});
  require_simulated_signal(log, rig);
  const SimulationSteps steps = steps_of(how);
  report::Header& header = invocation.header();
  *header.settings = {{"step", steps.step}, {"impact_step", steps.impact_step}};
  if (invocation.dry_run()) return;
  const Simulation simulated = simulate(log, table, rig, how);
  write_simulation(options.output, log, simulated, rig);

  header.simulations = 1;
  invocation.note(simulated.notes);
  if (invocation.wants_report())
    invocation.write_report(report::simulate_page(header, replay_of(log, table, rig, "simulated")));
  report::Json signals = {{{"signal", name_of(Signal::time)}, {"unit", output_column(log, Signal::time, {}).unit}}};
  std::vector<std::string> names;
  for (const OutputColumn& c : simulated.columns) {
    signals.push_back({{"signal", name_of(c.signal)}, {"unit", c.unit}});
    names.emplace_back(name_of(c.signal));
  }
  invocation.finish(fmt::format("simulated {} at {} samples: {}\n", report::join(names), log.samples(), options.output),
                    {{"output", options.output}, {"samples", log.samples()}, {"signals", signals}});
}

}  // namespace

void add_simulate_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("simulate", "The model driven by a log's inputs");
  command->add_option("LOG", options->log, "rig log, CSV")->required();
  command->add_option("--params", options->params, "parameter table, CSV")->required()->type_name("P");
  command->add_option("-o,--output", options->output, "the log's measured signals, simulated")
      ->required()
      ->type_name("SIM.csv");
  command->add_option("--step", options->step, "largest step of the integrator [s]")->type_name("S");
  command->add_flag("--reference", options->reference, "steps of 1e-5 s: slow, to compare with");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
