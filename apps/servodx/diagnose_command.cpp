// `servodx diagnose LOG...`: detect, classify, size. Each log alone.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "base/error.h"
#include "base/progress.h"
#include "commands.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "fit/replay.h"
#include "invocation.h"
#include "parameters/table.h"
#include "report/baseline_file.h"
#include "report/diagnosis_words.h"
#include "report/json.h"
#include "report/pages.h"
#include "report/text.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params, baseline;
  bool exit_code = false, pool = false;
};

int code_of(const Diagnosis& diagnosis) {
  switch (diagnosis.verdict) {
    case VerdictKind::healthy:
      return ran;
    case VerdictKind::fault:
      return found_fault;
    case VerdictKind::unknown:
      return found_unknown;
  }
  return ran;
}

std::vector<Diagnosis> judge_each(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                                  const DetectionBaseline& baseline, const DiagnoseOptions& options) {
  Progress progress("diagnose", {.quiet = options.quiet});
  std::vector<Diagnosis> results;
  long simulations = 0;
  for (const Log& log : logs) {
    if (*options.stop) break;
    DiagnoseOptions of_log = options;
    of_log.progress = [&](double part, long so_far) {
      progress.update((static_cast<double>(results.size()) + part) / static_cast<double>(logs.size()),
                      simulations + so_far);
    };
    Assessment assessment = assess(log, tuned, rig, of_log);
    if (*options.stop) break;
    results.push_back(judge(std::move(assessment), baseline));
    simulations += results.back().assessment.simulations;
    progress.update(static_cast<double>(results.size()) / static_cast<double>(logs.size()), simulations);
  }
  return results;
}

// Of the worst logs: a page of many would be too large to open.
std::vector<Replay> replays(const std::vector<Log>& logs, const Table& tuned, const RigFile& rig,
                            const std::vector<Diagnosis>& results) {
  std::vector<const Diagnosis*> worst;
  for (const Diagnosis& d : results) worst.push_back(&d);
  std::stable_sort(worst.begin(), worst.end(), [](const auto* a, const auto* b) { return a->error > b->error; });
  if (worst.size() > report::most_replays) worst.resize(report::most_replays);
  std::vector<Replay> all;
  for (const Diagnosis* d : worst)
    for (const Log& log : logs)
      if (log.path == d->log) {
        all.push_back(replay(log, tuned, rig, report::candidates_of(d->assessment.explanations)));
        break;
      }
  return all;
}

int run(const Options& options) {
  require_option(!options.pool, "--pool", "logs cannot be pooled yet", "leave it out: each log is judged alone");
  Invocation invocation("diagnose", options.common);
  auto inputs = options.logs;
  inputs.insert(inputs.end(), {options.params, options.baseline});
  invocation.check_files(inputs, {});
  const RigFile rig = invocation.rig();
  const Table tuned = invocation.tuned_table(options.params);
  const report::BaselineFile file = report::read_baseline(options.baseline);
  report::require_same_table(file.baseline, options.baseline, tuned.path, tuned.sha256);
  std::vector<Log> logs;
  for (const std::string& path : options.logs) logs.push_back(invocation.log(path, rig));
  report::Header& header = invocation.header();
  header.inputs.push_back({options.baseline, file.sha256});

  std::vector<std::string> truths;
  for (const Log& log : logs)
    if (invocation.wants_report()) truths.push_back(report::truth_beside(log.path, log.sha256));

  header.settings = {{"false_alarm", file.baseline.asked}};
  invocation.tell_of_long_fits(logs);
  if (invocation.dry_run()) return ran;

  const std::atomic<bool>& stop = stop_on_interrupt();
  const std::vector<Diagnosis> results = judge_each(
      logs, tuned, rig, file.baseline,
      {.seed = options.common.seed, .threads = options.common.threads, .quiet = options.common.quiet, .stop = &stop});
  std::string text;
  int worst = ran;
  for (const Diagnosis& d : results) {
    header.simulations += d.assessment.simulations;
    header.failed_simulations += d.assessment.failed_simulations;
    invocation.note(d.assessment.notes);
    text += (text.empty() ? "" : "\n") + report::text_of(d, {.colour = colour_wanted(), .written_to = ""});
    worst = std::max(worst, code_of(d));
  }
  if (results.size() < logs.size())
    invocation.note({fmt::format("interrupted: {} of {} logs were judged", results.size(), logs.size())});
  if (invocation.wants_report()) {
    truths.resize(results.size());
    invocation.write_report(
        report::diagnose_page(header, results, file.baseline, replays(logs, tuned, rig, results), truths));
  }
  invocation.finish(text, report::diagnose_json(results));
  return stop ? interrupted : options.exit_code ? worst : ran;
}

}  // namespace

void add_diagnose_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("diagnose", "Detect, name and size a fault; each log alone");
  command->add_option("LOG", options->logs, "rig logs, CSV")->required();
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("--baseline", options->baseline, "its baseline")->required()->type_name("BASE.json");
  command->add_flag("--exit-code", options->exit_code,
                    "end with 10 for a fault, 11 for unknown: the highest of the logs");
  command->add_flag("--pool", options->pool, "not yet: it is refused")->group("");  // the name is kept, help is silent
  add_common_options(*command, options->common);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
