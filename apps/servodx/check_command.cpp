// `servodx check LOG`: the prognostic checks of one log, stored in the valve's history. Of many: check_list.h.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/progress.h"
#include "check_list.h"
#include "commands.h"
#include "invocation.h"
#include "report/check/check_report.h"
#include "report/shared/conditions.h"
#include "report/shared/json.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/trend.h"
#include "servodx/tune.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string log, params, history, valve, serial, list, out;
  std::optional<double> hours, cycles;
  CheckOptions check;
  bool no_track = false, raw = false;
};

// With its progress on standard error. An interrupt ends the program: nothing is stored until all is done.
Checked checked_of(const Log& log, const Tuned& tuned, const RigFile& rig, CheckOptions how, bool quiet) {
  Progress progress("check", {.quiet = quiet});
  how.watch.progress = [&](const WorkDone& done) { progress.update(done.part, done.simulations); };
  return check(log, tuned, rig, how);
}

CheckOptions check_options(const Options& options) {
  CheckOptions how = options.check;
  how.threads = options.common.threads;
  how.track = !options.no_track;
  how.correct = !options.raw;
  return how;
}

// What a list gives for each of its logs, a call for its one.
void require_one_log(const Options& options) {
  require_option(!options.log.empty(), "LOG", "no log is named",
                 "name the log, or a file that lists logs with their valves and hours with --list FILE");
  require_option(!options.valve.empty(), "--valve", "the name is empty", "name the valve");
  require_option(options.hours.has_value(), "--at", "is required: the hours of use", "--at 1250.5");
  require_option(!options.params.empty(), "--params", "is required: the tuned table of this valve",
                 "--params tuned.csv");
}

void run_one(const Options& options) {
  require_one_log(options);
  const double at = *options.hours;
  require_option(std::isfinite(at) && at >= 0, "--at", "must be the hours of use, 0 or more", "--at 1250.5");
  require_option(!options.cycles || (std::isfinite(*options.cycles) && *options.cycles >= 0), "--cycles",
                 "must be a number, 0 or more", "--cycles 120000");
  Invocation invocation("check", options.common);
  invocation.check_files({options.log, options.params}, {options.history});
  CheckOptions how = check_options(options);
  how.validate();
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  const Log log = invocation.log(options.log, rig);
  report::add_to_head(invocation.header().head, {log});
  std::optional<History> history;  // a new one is made only when there is something to store
  if (History::there(options.history)) history = History::open(options.history);

  report::Header& header = invocation.header();
  *header.settings = check_settings(options.valve, at, how.model, options.history);
  if (invocation.dry_run()) return;

  const std::string serial = options.serial.empty() ? rig.serial : options.serial;
  const Before before = before_check(history, options.valve, serial);
  how.last = before.last;
  invocation.note(before.notices);
  const Checked checked = checked_of(log, tuned, rig, how, options.common.quiet);
  if (!history) history = History::open_or_make(options.history);
  history->record(options.valve, {.at = at, .cycles = options.cycles, .serial = serial}, checked, tuned);

  const auto& result = *checked.whole;
  header.simulations = checked.simulations;
  header.failed_simulations = checked.failed_simulations;
  invocation.note(checked.notes);
  if (invocation.wants_report()) invocation.write_report(report::check_page(header, result, log.time));
  invocation.finish(report::text_of(result), report::check_json(result));
}

int run(const Options& options) {
  if (options.list.empty()) {
    run_one(options);
    return ran;
  }
  const bool names_one =
      !options.log.empty() || !options.valve.empty() || options.hours || options.cycles || !options.serial.empty();
  require_option(!names_one, "--list", "a log, its valve or its hours are named in the call too",
                 "leave LOG, --valve, --at, --cycles and --serial to the list");
  return check_list(options.common, {.list = options.list,
                                     .out = options.out,
                                     .params = options.params,
                                     .history = options.history,
                                     .check = check_options(options)});
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "Prognostic checks of a log, or of a list, stored in a history");
  command->add_option("LOG", options->log, "rig log, CSV: in service, or a preflight test");
  CLI::Option* list =
      command
          ->add_option("--list", options->list,
                       "in place of LOG: a CSV with the columns log, valve, hours and, where they are known, cycles, "
                       "serial, params; logs relative to the working directory ('-': standard input)")
          ->type_name("FILE");
  command->add_option("--out", options->out, "with --list: folder of the results, one JSON a check; made if need be")
      ->type_name("DIR")
      ->needs(list);
  command->add_option("--params", options->params, "tuned table of this valve; with --list of rows that name none")
      ->type_name("TUNED");
  command->add_option("--history", options->history, "history file; made where there is none")
      ->required()
      ->type_name("H.db");
  command->add_option("--valve", options->valve, "name of the valve in the history")->type_name("ID");
  command->add_option("--at", options->hours, "hours of use at this check")->type_name("HOURS");
  command->add_option("--cycles", options->cycles, "cycles of use at this check")->type_name("N");
  command->add_option("--serial", options->serial, "serial number; else the rig file's")->type_name("SN");
  command->add_option("--model", options->check.model, "pressure model of the monitor")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_flag("--no-track", options->no_track, "leave the parameter estimates out");
  command->add_flag("--raw", options->raw, "no correction to 40 degC");
  add_common_options(*command, options->common);
  command->footer(
      "With --list a check that the history holds for the same log, valve, hours and table is passed over; a log that\n"
      "is refused is set aside with its reason and the rest goes on: exit code 3.\n"
      "Example: servodx check --list checks.csv --history h.db --params tuned.csv --rig rig.toml");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
