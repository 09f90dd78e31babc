// `servodx sensitivity LOG...`: every row of the table at its minimum and maximum, ranked by what that changes.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "invocation.h"
#include "report/sensitivity/sensitivity.h"
#include "servodx/data_sheet.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/sensitivity.h"
#include "servodx/table.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params;
};

int run(const Options& options) {
  Invocation invocation("sensitivity", options.common);
  auto inputs = options.logs;
  inputs.push_back(options.params);
  invocation.check_files(inputs, {});
  const RigFile rig = invocation.rig();
  const Table table = apply_rig_facts(invocation.table(options.params), rig);
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  if (invocation.dry_run()) return ran;

  const Sensitivity result = drive_rows(logs, table, rig, options.common.threads, invocation.watch());
  invocation.header().simulations = result.simulations;
  invocation.header().failed_simulations = result.failed_simulations;
  for (const Log& log : logs) invocation.note(log.notes);
  if (invocation.wants_report()) invocation.write_report(report::sensitivity_page(invocation.header(), result));
  invocation.finish(report::text_of(result), report::sensitivity_json(result));
  return result.interrupted ? interrupted : ran;
}

}  // namespace

void add_sensitivity_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "sensitivity", "What every row of the table changes at its minimum and maximum, strongest first");
  command->add_option("LOG", options->logs, "rig logs, CSV: what they excite is what they show")->required();
  command->add_option("--params", options->params, "parameter table, tuned or not")->required()->type_name("P");
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
