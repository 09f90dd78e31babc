// `servodx explain LOG...`: what the simulation gets wrong, where, why, and what mending it gains; logs pooled.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "baseline_beside.h"
#include "commands.h"
#include "invocation.h"
#include "report/explain/explain_report.h"
#include "report/shared/conditions.h"
#include "report/shared/json.h"
#include "report/shared/replay_part.h"
#include "servodx/baseline.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/pages.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params, baseline, output;
  std::vector<std::string> without;
  bool keep_worse = false;
  RunOptions run;
};

int run(const Options& options) {
  ExplainOptions how{.seed = options.common.seed,
                     .threads = options.common.threads,
                     .without = options.without,
                     .keep_worse = options.keep_worse};
  how.validate();
  Invocation invocation("explain", options.common, options.run);
  auto inputs = options.logs;
  inputs.push_back(options.params);
  if (!options.baseline.empty()) inputs.push_back(options.baseline);
  invocation.check_files(inputs, {options.output});
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  report::Header& header = invocation.header();
  std::optional<Baseline> baseline;
  if (!options.baseline.empty()) {
    baseline = baseline_beside(invocation, options.baseline, rig);
    require_same_table(*baseline, tuned);
    header.inputs.push_back({options.baseline, baseline->sha256});
    require_causes(*baseline);
    how.level = baseline->asked;
  }
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  report::add_to_head(invocation.header().head, logs);
  *header.settings = {{"level", how.level}, {"baseline", options.baseline}, {"without", options.without}};
  invocation.tell_of_long_fits(logs);
  if (invocation.dry_run()) return ran;

  how.watch = invocation.watch();
  const Explanation explanation = baseline ? explain(logs, tuned, rig, *baseline, how) : explain(logs, tuned, rig, how);
  const auto& result = *explanation.whole;
  write_table(options.output, explanation.table);
  header.simulations = explanation.simulations;
  header.failed_simulations = explanation.failed_simulations;
  for (const Log& log : logs) invocation.note(log.notes);
  invocation.note(explanation.notes);
  if (explanation.interrupted) invocation.note_how_to_go_on();
  if (invocation.wants_report())
    invocation.write_report(
        report::explain_page(header, result, replays_of(explanation, logs, tuned, rig, report::most_replays)));
  invocation.finish(report::text_of(result, {.colour = colour_wanted(), .written_to = options.output}),
                    report::explain_json(result));
  return explanation.interrupted ? interrupted : ran;
}

}  // namespace

void add_explain_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "explain", "What the simulation gets wrong, where, why, and what mending it gains; logs are pooled");
  command->add_option("LOG", options->logs, "rig logs of one valve in one state, CSV")->required();
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("--baseline", options->baseline, "its baseline: then only of what healthy logs do not show")
      ->type_name("BASE.json");
  command->add_option("-o,--output", options->output, "the extended table")->required()->type_name("EXTENDED.csv");
  command
      ->add_option("--without", options->without,
                   "leave an effect out of the list: what is found then, if not its name")
      ->type_name("EFFECT");
  command->add_flag("--keep-worse", options->keep_worse,
                    "write the extension even where the simulation's held-out rms is worse with it");
  add_run_options(*command, options->run);
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
