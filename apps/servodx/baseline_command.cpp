// `servodx baseline LOG...`: what fault-free logs score, and the threshold that promises a false-alarm rate.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands.h"
#include "invocation.h"
#include "report/baseline/baseline_json.h"
#include "report/baseline/baseline_page.h"
#include "report/baseline/baseline_text.h"
#include "report/shared/conditions.h"
#include "report/shared/going_on.h"
#include "report/shared/json.h"
#include "report/shared/replay_part.h"
#include "report/shared/text_options.h"
#include "servodx/baseline.h"
#include "servodx/log.h"
#include "servodx/pages.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "tuning_logs.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs, others;
  bool alone = false;
  std::string params, output;
  double false_alarm = BaselineOptions{}.false_alarm;
  RunOptions run;
};

int run(const Options& options) {
  BaselineOptions how;
  how.false_alarm = options.false_alarm, how.seed = options.common.seed, how.threads = options.common.threads;
  how.validate();
  Invocation invocation("baseline", options.common, options.run);
  auto inputs = options.logs;
  inputs.insert(inputs.end(), options.others.begin(), options.others.end());
  inputs.push_back(options.params);
  invocation.check_files(inputs, {options.output});
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  const std::vector<Log> logs = invocation.logs(options.logs, rig);
  report::add_to_head(invocation.header().head, logs);
  std::vector<std::string> others = options.others;
  if (others.empty() && !options.alone) {
    others = tuning_logs(options.params, tuned.table);
    inputs.insert(inputs.end(), others.begin(), others.end());
    invocation.check_files(inputs, {options.output});  // found, not named: no output is one of them all the same
  }
  how.others = invocation.logs(others, rig);

  report::Header& header = invocation.header();
  *header.settings = {{"false_alarm", options.false_alarm}};
  if (!how.others.empty() && options.others.empty())
    invocation.note(
        {fmt::format("{} logs that tuned the table show how it errs on tests that are not given here; "
                     "--alone leaves them out",
                     how.others.size())});
  invocation.tell_of_long_fits(logs);
  require_baseline_logs(logs, tuned, how);
  if (invocation.dry_run()) return ran;

  how.watch = invocation.watch();
  const Baseline baseline = make_baseline(logs, tuned, rig, how);
  header.simulations = baseline.simulations, header.failed_simulations = baseline.failed_simulations;
  invocation.note(baseline.notes);
  if (baseline.interrupted) invocation.note_how_to_go_on();
  constexpr std::size_t fewest = 3;  // that set a threshold
  if (baseline.interrupted && baseline.scores.size() < fewest) {
    invocation.finish_without_result(report::too_few_for_a_baseline(baseline.scores.size(), logs.size()) + "\n");
    return interrupted;
  }
  if (invocation.wants_report())
    invocation.write_report(
        report::baseline_page(header, baseline, replays_of(baseline, logs, tuned, rig, report::most_replays)));
  write_baseline(options.output, baseline);
  invocation.finish(report::text_of(baseline, {.colour = colour_wanted(), .written_to = options.output}),
                    report::baseline_json(baseline));
  return baseline.interrupted ? interrupted : ran;
}

}  // namespace

void add_baseline_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("baseline", "Detection threshold from fault-free logs that did not tune the table");
  command->add_option("LOG", options->logs, "fault-free rig logs, CSV")->required();
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("-o,--output", options->output, "the baseline, JSON")->required()->type_name("BASE.json");
  CLI::Option* others =
      command->add_option("--others", options->others,
                          "fault-free logs of other tests, those that tuned the table as well: how the model errs "
                          "there; the tuning logs, where they still are, if none is given");
  command->add_flag("--alone", options->alone, "no logs but those given, as of the baseline's own test")
      ->excludes(others);
  command->add_option("--false-alarm", options->false_alarm, "rate of false alarms asked for, per log")
      ->type_name("RATE")
      ->capture_default_str();
  add_run_options(*command, options->run);
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
