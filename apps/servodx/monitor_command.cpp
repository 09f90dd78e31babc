// `servodx monitor LOG`: the monitor model of Borello et al. 2009, Fig. 5, driven by the log's current.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "commands.h"
#include "fit/log_data.h"
#include "fit/nominal.h"
#include "invocation.h"
#include "prognose/checks.h"
#include "prognose/monitor.h"
#include "report/shared/conditions.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, output, model = "linear", loop_gain;
};

void run(const Options& options) {
  Invocation invocation("monitor", options.common);
  invocation.check_files({options.log, options.params}, {options.output});
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(options.params), rig);
  const Log log = invocation.log(options.log, rig);
  report::add_to_head(invocation.header().head, {log});
  const LogData data = prepare(log, rig);
  MonitorParameters monitor = monitor_parameters(table, supply_of(data, table));
  const PressureLaw law = pressure_law(options.model, table, supply_of(data, table));
  const bool closed = !options.loop_gain.empty();
  if (closed) {
    require_option(log.has(Signal::setpoint), "--loop-gain", "the log has no 'setpoint' to close the loop on",
                   "leave it away: the measured current drives the monitor");
    monitor.control_gain = parse_gain(options.loop_gain, Dimension::current, {.file = "--loop-gain"}).value;
  }
  *invocation.header().settings = {{"model", options.model}, {"loop_gain", monitor.control_gain}};
  if (invocation.dry_run()) return;

  const auto before = std::chrono::steady_clock::now();
  MonitorRun run =
      closed ? run_monitor_loop(monitor, law, data, log[Signal::setpoint]) : run_monitor(monitor, law, data);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
  const double simulated = log.time.back() - log.time.front();

  report::Json error = nullptr;
  std::string text = fmt::format("monitored {} s at {} samples: {}\n{:.0f} times real time\n",
                                 report::digits(simulated), log.samples(), options.output, simulated / wall);
  if (log.has(Signal::spool_position)) {
    const MeanError e = mean_error(log.time, log[Signal::spool_position], run.spool);
    error = {{"value", e.figure.value},
             {"std_error", e.figure.std_error},
             {"unit", "m"},
             {"settled_at", e.settled_at},
             {"settled", e.settled}};
    text += fmt::format("mean error {} +- {}, {}\n", report::handy(e.figure.value, "m"),
                        report::handy(e.figure.std_error, "m"),
                        e.settled ? fmt::format("settled from {} on", report::duration(e.settled_at))
                                  : "not settled: the log is short for its variation");
  }
  write_log(options.output, {output_column(log, Signal::time, log.time),
                             output_column(log, Signal::spool_position, std::move(run.spool)),
                             output_column(log, Signal::piston_position, std::move(run.piston)),
                             output_column(log, Signal::load_pressure, std::move(run.pressure))});
  invocation.note(data.notes);
  invocation.header().simulations = 1;
  invocation.finish(text, {{"output", options.output},
                           {"samples", log.samples()},
                           {"real_time_factor", simulated / wall},
                           {"mean_error", error},
                           {"parameters",
                            {{"GM [N/A]", monitor.motor_gain},
                             {"KSF [N/m]", monitor.wire_stiffness},
                             {"KFt [N/m]", monitor.flapper_stiffness},
                             {"XFM [m]", monitor.flapper_limit},
                             {"GQF/ASV [1/s]", monitor.first_stage_gain},
                             {"XSM [m]", monitor.spool_limit},
                             {"GP [Pa/m]", monitor.pressure_gain},
                             {"GQ [m2/s]", monitor.flow_gain},
                             {"PSR [Pa]", monitor.pressure_limit},
                             {"AJ [m2]", monitor.piston_area},
                             {"CJ [N s/m]", monitor.viscous},
                             {"MJ [kg]", monitor.mass},
                             {"XJM [m]", monitor.piston_limit}}}});
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
