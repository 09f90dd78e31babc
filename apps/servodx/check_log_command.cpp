// `servodx check-log LOG...`: what is in a log, what it can identify, what is suspicious, before any fit.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/sha256.h"
#include "base/trouble.h"
#include "commands.h"
#include "invocation.h"
#include "report/check_log/check_log.h"
#include "servodx/check_log.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "tuning_logs.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params;
};

// Of the logs that tuned the table. One that this call's rig file does not fit is left out: it is not what was asked.
std::vector<OperatingPoint> tuning_points(Invocation& invocation, const Options& options, const Table& table,
                                          const RigFile& rig, const std::vector<Log>& logs) {
  std::vector<OperatingPoint> points;
  auto inputs = options.logs;
  for (const std::string& path : tuning_logs(options.params, table)) {
    inputs.push_back(path);
    const std::string hash = sha256_of_file(path);
    const auto same = std::find_if(logs.begin(), logs.end(), [&](const Log& log) { return log.sha256 == hash; });
    try {
      points.push_back(operating_point_of(same != logs.end() ? *same : invocation.log(path, rig)));
    } catch (const InputError& other) {
      invocation.note({"a log that tuned the table is left out of the operating points: " + told(other)});
    }
  }
  invocation.check_files(inputs, {});  // found, not named: no output is one of them all the same
  return points;
}

void run(const Options& options) {
  Invocation invocation("check-log", options.common);
  auto inputs = options.logs;
  if (!options.params.empty()) inputs.push_back(options.params);
  invocation.check_files(inputs, {});
  const RigFile rig = invocation.rig();
  const std::optional<Table> table =
      options.params.empty() ? std::nullopt : std::optional<Table>(invocation.table(options.params));
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  const std::vector<OperatingPoint> tuning =
      table ? tuning_points(invocation, options, *table, rig, logs) : std::vector<OperatingPoint>();
  if (invocation.dry_run()) return;
  std::vector<LogSurvey> surveys;
  for (const Log& log : logs) surveys.push_back(survey(log, rig)), set_beside_tuning(surveys.back().conditions, tuning);
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
