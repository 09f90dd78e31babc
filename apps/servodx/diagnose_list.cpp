#include "diagnose_list.h"

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "base/progress.h"
#include "base/sha256.h"
#include "fleet/log_list.h"
#include "fleet/result_file.h"
#include "fleet/run.h"
#include "fleet_judge.h"
#include "list_run.h"
#include "report/fleet/fleet.h"
#include "report/shared/json.h"
#include "result_folder.h"
#include "servodx/diagnose.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

FleetRun judge_all(const std::vector<std::string>& logs, FleetJudge& judge, const CommonOptions& common,
                   const ListOptions& list, report::Header& header) {
  const std::atomic<bool>& stop = stop_on_interrupt(true);
  FleetRun run;
  run.out = list.out, run.logs = logs.size();
  DiagnoseOptions options{
      .seed = common.seed, .threads = common.threads, .watch = {.stop = [&stop] { return stop.load(); }}};
  run_list("diagnose", run, common.quiet, [&](std::size_t place, Progress& progress, const Tell& tell) {
    options.watch.progress = [&tell](const WorkDone&) { tell(); };
    const FleetJudge::Outcome outcome = judge.judge(logs[place], result_name(logs[place]), options);
    add(run, outcome, progress, header, judge.header());
  });
  return run;
}

}  // namespace

int diagnose_list(const CommonOptions& common, const RunOptions& run_options, const ListOptions& options,
                  const std::string& params, const std::string& baseline) {
  require_option(common.report.empty() && common.pdf.empty(), common.report.empty() ? "--pdf" : "--report",
                 "a list has no page of its own",
                 "'servodx gather " + (options.out.empty() ? "DIR" : options.out) + " --report FILE.html' makes it");
  require_folder("--out", options.out);
  Invocation invocation("diagnose", common, run_options);
  std::vector<std::string> inputs = {params, baseline};
  if (!options.actions.empty()) inputs.push_back(options.actions);
  if (!is_standard_input(options.list)) inputs.push_back(options.list);
  invocation.check_files(inputs, {});
  const Chunk chunk = read_chunk(options.chunk);
  const Judging judging = read_judging(invocation, {params, baseline, options.actions}, options.explain_unknown);
  const std::vector<std::string> logs = read_log_list(options.list, chunk);
  report::Header& header = invocation.header();
  if (common.dry_run) rehearse_list(logs, judging.rig, header);
  if (invocation.dry_run()) return ran;
  FleetJudge judge(invocation, judging, options.out);
  judge.pages = options.pages;
  // What can be read but once has no hash.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(options.list, ignored))
    header.inputs.push_back({options.list, sha256_of_file(options.list)});
  header.settings->update({{"list", options.list}, {"out", options.out}, {"chunk", options.chunk}});
  const FleetRun run = judge_all(logs, judge, common, options, header);
  invocation.note(interrupt_notice(run));
  invocation.finish(report::text_of(run), report::fleet_run_json(run));
  return code_of(run, options.exit_code);
}

}  // namespace servodx
