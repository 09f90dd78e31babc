// `servodx baseline LOG...`: what fault-free logs score, and the threshold that promises a false-alarm rate.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "base/atomic_file.h"
#include "base/progress.h"
#include "commands.h"
#include "diagnose/diagnose.h"
#include "explain/healthy.h"
#include "invocation.h"
#include "report/diagnosis_words.h"
#include "report/explain_report.h"
#include "report/pages.h"
#include "report/text.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params, output;
  double false_alarm = DetectionBaseline{}.asked;
};

// What `explain` asks of healthy logs.
HealthyReference healthy(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig, const Options& options,
                         report::Header& header) {
  Progress progress("baseline, causes", {.quiet = options.common.quiet});
  HealthyCounts counts{header.simulations, header.failed_simulations};
  const auto told = [&](double done) {
    progress.update(done, counts.simulations);
    return !stop_on_interrupt();
  };
  HealthyReference out = score_healthy(logs, tuned, rig, options.common.threads, counts, told);
  header.simulations = counts.simulations, header.failed_simulations = counts.failed;
  return out;
}

int run(const Options& options) {
  require_option(options.false_alarm > 0 && options.false_alarm < 1, "--false-alarm", "is a rate between 0 and 1",
                 "0.01 is one false alarm in a hundred fault-free logs");
  Invocation invocation("baseline", options.common);
  auto inputs = options.logs;
  inputs.push_back(options.params);
  invocation.check_files(inputs, {options.output});
  const RigFile rig = invocation.rig();
  const Table tuned = invocation.tuned_table(options.params);
  const std::vector<Log> logs = invocation.logs(options.logs, rig);

  report::Header& header = invocation.header();
  header.settings = {{"false_alarm", options.false_alarm}};
  invocation.tell_of_long_fits(logs);
  if (invocation.dry_run()) return ran;

  const std::atomic<bool>& stop = stop_on_interrupt();
  const DetectionBaseline baseline = make_baseline(
      logs, tuned, rig, options.false_alarm,
      {.seed = options.common.seed, .threads = options.common.threads, .quiet = options.common.quiet, .stop = &stop},
      &header.simulations, &header.failed_simulations);
  for (const Log& log : logs) invocation.note(log.notes);
  if (baseline.scores.size() < logs.size())
    invocation.note({fmt::format("interrupted: rests on {} of {} logs", baseline.scores.size(), logs.size())});
  if (invocation.wants_report()) {
    std::vector<Replay> replays;
    for (std::size_t i = 0; i < std::min(baseline.scores.size(), report::most_replays); ++i)
      if (const auto& healthy = baseline.scores[i].healthy)
        replays.push_back(replay(logs[i], tuned, rig, report::candidates_of({*healthy})));
    invocation.write_report(report::baseline_page(header, baseline, replays));
  }
  report::Json body = report::baseline_json(baseline);
  body["explain"] = report::healthy_json(healthy(logs, tuned, rig, options, header));
  write_file(options.output, invocation.result(body));
  invocation.finish(report::text_of(baseline, {.colour = colour_wanted(), .written_to = options.output}), body);
  return stop ? interrupted : ran;
}

}  // namespace

void add_baseline_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("baseline", "Detection threshold from fault-free logs that did not tune the table");
  command->add_option("LOG", options->logs, "fault-free rig logs, CSV")->required();
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("-o,--output", options->output, "the baseline, JSON")->required()->type_name("BASE.json");
  command->add_option("--false-alarm", options->false_alarm, "rate of false alarms asked for, per log")
      ->type_name("RATE")
      ->capture_default_str();
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
