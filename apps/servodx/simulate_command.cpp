// `servodx simulate LOG`: the model driven by the log's inputs; writes the log's measured signals, simulated.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <stdexcept>

#include "base/error.h"
#include "commands.h"
#include "fit/log_data.h"
#include "fit/nominal.h"
#include "invocation.h"
#include "report/columns.h"
#include "report/handy.h"
#include "report/pages.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

constexpr double reference_step = 1e-5;  // [s] where the integrator's error is far below every sensor's

struct Options {
  CommonOptions common;
  std::string log, params, output;
  double step = fine_steps().step;  // [s]
  bool step_given = false, reference = false;
};

SimulateOptions simulate_options(const Options& options, const LogData& data) {
  SimulateOptions to = fine_steps();
  to.threads = options.common.threads;
  if (options.reference) to.step = to.impact_step = to.creep_step = reference_step;
  if (options.step_given) {
    to.impact_step = std::min(to.impact_step, options.step);
    to.step = options.step;
    to.creep_step = options.step;
  }
  to.wanted.fill(false);
  for (const FitChannel& channel : data.channels) to.wanted[channel.simulated] = true;
  return to;
}

void run(const Options& options) {
  require_option(options.step > 0 && options.step <= 0.1, "--step", "must lie between 0 and 0.1 s",
                 "give it in seconds: 1e-4");
  require_option(!options.step_given || !options.reference, "--reference", "sets the step, as --step does",
                 "give one of them");
  Invocation invocation("simulate", options.common);
  invocation.check_files({options.log, options.params}, {options.output});
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(options.params), rig);
  const Log log = invocation.log(options.log, rig);
  const LogData data = prepare(log, rig);
  require_channels(data);
  const ParameterVector candidate = candidate_of(table);
  const SimulateOptions how = simulate_options(options, data);
  report::Header& header = invocation.header();
  header.settings = {{"step", how.step}, {"impact_step", how.impact_step}};
  if (invocation.dry_run()) return;
  Trajectory simulated = simulate(data.scenario, candidate, how);
  if (!simulated.ok)
    throw std::runtime_error(
        fmt::format("the simulation left the finite numbers at {} s; check {} or give a smaller --step",
                    simulated.failed_at, options.params));

  std::vector<OutputColumn> columns = {output_column(log, Signal::time, log.time)};
  std::vector<std::string> names;
  for (const FitChannel& channel : data.channels) {
    columns.push_back(output_column(log, channel.signal, std::move(simulated.signals[channel.simulated])));
    names.emplace_back(info(channel.signal).name);
  }
  write_log(options.output, columns);

  header.simulations = 1;
  invocation.note(data.notes);
  if (invocation.wants_report())
    invocation.write_report(report::simulate_page(header, replay(log, table, rig, {{"simulated", candidate}})));
  report::Json signals = report::Json::array();
  for (const OutputColumn& c : columns) signals.push_back({{"signal", info(c.signal).name}, {"unit", c.unit}});
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
  CLI::Option* step =
      command->add_option("--step", options->step, "largest step of the integrator [s]")->type_name("S");
  command->add_flag("--reference", options->reference, "steps of 1e-5 s: slow, to compare with");
  add_common_options(*command, options->common);
  command->callback([options, step] {
    options->step_given = step->count() > 0;
    run(*options);
  });
}

}  // namespace servodx
