// `servodx monitor LOG`: the monitor model of Borello et al. 2009, Fig. 5, driven by the log's current.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "commands.h"
#include "invocation.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/monitor.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, output, model = "linear", loop_gain;
};

void run(const Options& options) {
  MonitorOptions how{.model = options.model};
  if (!options.loop_gain.empty())
    how.loop_gain = parse_gain(options.loop_gain, Dimension::current, {.file = "--loop-gain"}).value;
  how.validate();
  Invocation invocation("monitor", options.common);
  invocation.check_files({options.log, options.params}, {options.output});
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(options.params), rig);
  const Log log = invocation.log(options.log, rig);
  report::add_to_head(invocation.header().head, {log});
  const LogMonitor monitor(log, table, rig, how);
  const MonitorParameters& parameters = monitor.parameters();
  *invocation.header().settings = {{"model", options.model}, {"loop_gain", parameters.control_gain}};
  if (invocation.dry_run()) return;

  const auto before = std::chrono::steady_clock::now();
  MonitorRun run = monitor.run();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  const double simulated = log.time.back() - log.time.front();

  report::Json error = nullptr;
  std::string text = fmt::format("monitored {} s at {} samples: {}\n{:.0f} times real time\n",
                                 report::digits(simulated), log.samples(), options.output, simulated / wall);
  if (const auto e = monitor.error_of(run)) {
    error = {{"value", e->value},
             {"std_error", e->std_error},
             {"unit", "m"},
             {"settled_at", e->settled_at},
             {"settled", e->settled}};
    text += fmt::format("mean error {} +- {}, {}\n", report::handy(e->value, "m"), report::handy(e->std_error, "m"),
                        e->settled ? fmt::format("settled from {} on", report::duration(e->settled_at))
                                   : "not settled: the log is short for its variation");
  }
  write_log(options.output, {output_column(log, Signal::time, log.time),
                             output_column(log, Signal::spool_position, std::move(run.spool)),
                             output_column(log, Signal::piston_position, std::move(run.piston)),
                             output_column(log, Signal::load_pressure, std::move(run.pressure))});
  invocation.note(monitor.notes());
  invocation.header().simulations = 1;
  invocation.finish(text, {{"output", options.output},
                           {"samples", log.samples()},
                           {"real_time_factor", simulated / wall},
                           {"mean_error", error},
                           {"parameters",
                            {{"GM [N/A]", parameters.motor_gain},
                             {"KSF [N/m]", parameters.wire_stiffness},
                             {"KFt [N/m]", parameters.flapper_stiffness},
                             {"XFM [m]", parameters.flapper_limit},
                             {"GQF/ASV [1/s]", parameters.first_stage_gain},
                             {"XSM [m]", parameters.spool_limit},
                             {"GP [Pa/m]", parameters.pressure_gain},
                             {"GQ [m2/s]", parameters.flow_gain},
                             {"PSR [Pa]", parameters.pressure_limit},
                             {"AJ [m2]", parameters.piston_area},
                             {"CJ [N s/m]", parameters.viscous},
                             {"MJ [kg]", parameters.mass},
                             {"XJM [m]", parameters.piston_limit}}}});
}

}  // namespace

void add_monitor_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("monitor", "The real-time monitor model of Borello et al. driven by a log");
  command->add_option("LOG", options->log, "rig log, CSV")->required();
  command->add_option("--params", options->params, "parameter table, tuned or not")->required()->type_name("TUNED");
  command->add_option("-o,--output", options->output, "spool, piston and load pressure of the monitor")
      ->required()
      ->type_name("SIM.csv");
  command->add_option("--model", options->model, "pressure model in place of GP")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--loop-gain", options->loop_gain, "close the loop on the log's setpoint: \"1.8 mA/mm\"")
      ->type_name("GAIN");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
