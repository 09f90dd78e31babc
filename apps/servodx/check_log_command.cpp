// `servodx check-log LOG...`: what is in a log, what it can identify, what is suspicious, before any fit.
#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "diagnose/check_log.h"
#include "invocation.h"
#include "report/check_log.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params;
};

void run(const Options& options) {
  Invocation invocation("check-log", options.common);
  auto inputs = options.logs;
  if (!options.params.empty()) inputs.push_back(options.params);
  invocation.check_files(inputs, {});
  const RigFile rig = invocation.rig();
  const std::optional<Table> table =
      options.params.empty() ? std::nullopt : std::optional<Table>(invocation.table(options.params));
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  if (invocation.dry_run()) return;
  std::vector<LogSurvey> surveys;
  for (const Log& log : logs) surveys.push_back(survey(log, rig));
  compare_surveys(surveys);
  std::vector<report::LogCheck> checks;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    report::LogCheck check{surveys[i], std::nullopt, logs[i].time,
                           logs[i][logs[i].has(Signal::coil_current) ? Signal::coil_current : Signal::command]};
    if (table) {
      check.promise = promise_of(logs[i], *table, rig, options.common.threads);
      invocation.header().simulations += check.promise->simulations;
    }
    checks.push_back(std::move(check));
  }
  if (invocation.wants_report()) invocation.write_report(report::check_log_page(invocation.header(), checks));
  invocation.finish(report::text_of(checks), report::check_log_json(checks));
}

}  // namespace

void add_check_log_command(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("check-log", "What is in a log, what it can identify, what is suspicious: before any fit");
  command->add_option("LOG", options->logs, "rig logs, CSV")->required();
  command
      ->add_option("--params", options->params,
                   "parameter table: also say which parameters and faults the log can show")
      ->type_name("P");
  add_common_options(*command, options->common);
  command->callback([options] { run(*options); });
}

}  // namespace servodx
