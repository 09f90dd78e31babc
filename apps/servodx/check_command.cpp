// `servodx check LOG`: the prognostic checks of one log, stored in the valve's history.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <optional>

#include "commands.h"
#include "invocation.h"
#include "prognose/check.h"
#include "report/json.h"
#include "report/prognosis.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/trend.h"
#include "servodx/tune.h"
#include "store/history.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, history, valve, serial;
  double at = 0;
  std::optional<double> cycles;
  CheckOptions check;
  bool no_track = false, raw = false;
};

void run(const Options& options) {
  require_option(!options.valve.empty(), "--valve", "the name is empty", "name the valve");
  require_option(std::isfinite(options.at) && options.at >= 0, "--at", "must be the hours of use, 0 or more",
                 "--at 1250.5");
  require_option(!options.cycles || (std::isfinite(*options.cycles) && *options.cycles >= 0), "--cycles",
                 "must be a number, 0 or more", "--cycles 120000");
  Invocation invocation("check", options.common);
  invocation.check_files({options.log, options.params}, {options.history});
  CheckOptions how = options.check;
  how.threads = options.common.threads;
  how.track = !options.no_track;
  how.correct = !options.raw;
  how.validate();
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  const Log log = invocation.log(options.log, rig);
  std::optional<History> history;  // a new one is made only when there is something to store
  if (HistoryFile::there(options.history)) history = History::open(options.history);

  report::Header& header = invocation.header();
  header.settings = {{"valve", options.valve}, {"at", options.at}, {"model", how.model}, {"history", options.history}};
  if (invocation.dry_run()) return;

  const std::string serial = options.serial.empty() ? rig.serial : options.serial;
  if (history) {
    how.last = history->tracked(options.valve);
    if (const std::string was = history->file().serial(options.valve); !was.empty() && !serial.empty() && was != serial)
      invocation.note(
          {fmt::format("'{}' was serial {} and is {} now: if the valve was swapped, "
                       "'servodx history event valve_swapped' starts its trends again",
                       options.valve, was, serial)});
  }
  const Checked checked = check(log, tuned, rig, how);
  if (!history) history = History::open_or_make(options.history);
  history->record(options.valve, {.at = options.at, .cycles = options.cycles, .serial = serial}, checked, tuned);

  const CheckResult& result = *checked.whole;
  header.simulations = result.simulations;
  header.failed_simulations = result.failed_simulations;
  invocation.note(result.notes);
  if (invocation.wants_report()) invocation.write_report(report::check_page(header, result, log.time));
  invocation.finish(report::text_of(result), report::check_json(result));
}

}  // namespace

void add_check_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "Prognostic checks of a log, stored in a valve's history");
  command->add_option("LOG", options->log, "rig log, CSV: in service, or a preflight test")->required();
  command->add_option("--params", options->params, "tuned table of this valve")->required()->type_name("TUNED");
  command->add_option("--history", options->history, "history file; made where there is none")
      ->required()
      ->type_name("H.db");
  command->add_option("--valve", options->valve, "name of the valve in the history")->required()->type_name("ID");
  command->add_option("--at", options->at, "hours of use at this check")->required()->type_name("HOURS");
  command->add_option("--cycles", options->cycles, "cycles of use at this check")->type_name("N");
  command->add_option("--serial", options->serial, "serial number; else the rig file's")->type_name("SN");
  command->add_option("--model", options->check.model, "pressure model of the monitor")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--no-track", options->no_track, "leave the parameter estimates out");
  command->add_flag("--raw", options->raw, "no correction to 40 degC");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
