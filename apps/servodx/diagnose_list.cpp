#include "diagnose_list.h"

#include <atomic>
#include <cstdio>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/progress.h"
#include "base/sha256.h"
#include "base/trouble.h"
#include "fleet/log_list.h"
#include "fleet/result_file.h"
#include "fleet/run.h"
#include "fleet_judge.h"
#include "report/fleet.h"
#include "report/json.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/watch.h"

namespace servodx {
namespace {

FleetRun judge_all(const std::vector<std::string>& logs, FleetJudge& judge, const CommonOptions& common,
                   const ListOptions& list, report::Header& header) {
  const std::atomic<bool>& stop = stop_on_interrupt(true);
  Progress progress("diagnose", {.quiet = common.quiet});
  FleetRun run;
  run.logs = logs.size();
  const auto tell = [&](const WorkDone&) {
    progress.show([&](double elapsed) { return logs_line("diagnose", run.done(), run.logs, run.judged, elapsed); });
  };
  const DiagnoseOptions options{.seed = common.seed,
                                .threads = common.threads,
                                .watch = {.progress = tell, .stop = [&stop] { return stop.load(); }},
                                .actions = actions_of(list.actions),
                                .explain_unknown = list.explain_unknown};
  for (const std::string& log : logs) {
    if (stop) run.interrupted = true;
    if (run.interrupted) break;
    const FleetJudge::Outcome outcome = judge.judge(log, result_name(log), options);
    add(run, outcome, progress, header, judge.header());
    tell({});
  }
  return run;
}

// A rehearsal reads every log and says which would be set aside.
void rehearse(const std::vector<std::string>& logs, const RigFile& rig, report::Header& header) {
  std::size_t refused_logs = 0;
  for (const std::string& path : logs) try {
      read_log(path, rig);
    } catch (const InputError& error) {
      std::fprintf(stderr, "diagnose: would be set aside: %s\n", told(error).c_str());
      ++refused_logs;
    }
  header.settings["logs"] = logs.size();
  header.settings["would_be_set_aside"] = refused_logs;
}

}  // namespace

int diagnose_list(const CommonOptions& common, const ListOptions& options, const std::string& params,
                  const std::string& baseline) {
  require_option(common.report.empty(), "--report", "a list has no page of its own",
                 "'servodx gather " + (options.out.empty() ? "DIR" : options.out) + " --report FILE.html' makes it");
  require_folder("--out", options.out);
  Invocation invocation("diagnose", common);
  std::vector<std::string> inputs = {params, baseline};
  if (!is_standard_input(options.list)) inputs.push_back(options.list);
  invocation.check_files(inputs, {});
  const Chunk chunk = read_chunk(options.chunk);
  const Judging judging = read_judging(invocation, params, baseline);
  const std::vector<std::string> logs = read_log_list(options.list, chunk);
  actions_of(options.actions);  // refused before the first log
  report::Header& header = invocation.header();
  if (common.dry_run) rehearse(logs, judging.rig, header);
  if (invocation.dry_run()) return ran;
  FleetJudge judge(invocation, judging, options.out);
  // What can be read but once has no hash.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(options.list, ignored))
    header.inputs.push_back({options.list, sha256_of_file(options.list)});
  header.settings.update({{"list", options.list}, {"out", options.out}, {"chunk", options.chunk}});
  FleetRun run = judge_all(logs, judge, common, options, header);
  run.out = options.out;
  if (run.interrupted) invocation.note({"interrupted: what is done is kept, and the same call goes on from there"});
  invocation.finish(report::text_of(run), report::fleet_run_json(run));
  return code_of(run, options.exit_code);
}

}  // namespace servodx
