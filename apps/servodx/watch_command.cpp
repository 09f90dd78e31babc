// `servodx watch DIR`: every new log of a folder diagnosed once it has settled. `--follow FILE` and `-`: follow.h.
#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "base/atomic_file.h"
#include "base/byte_tail.h"
#include "base/progress.h"
#include "commands.h"
#include "fleet/prometheus.h"
#include "fleet/result_file.h"
#include "fleet/run.h"
#include "fleet/settling.h"
#include "fleet_judge.h"
#include "follow.h"
#include "invocation.h"
#include "report/diagnose/diagnosis_text.h"
#include "report/fleet/fleet.h"
#include "report/shared/json.h"
#include "report/shared/text_options.h"
#include "result_folder.h"
#include "servodx/diagnose.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::string folder, out, params, baseline, prometheus;
  FollowOptions follow;
  double settle = 2, interval = 1;  // [s]
  bool once = false, pages = false, exit_code = false;
};

class Watching {
 public:
  Watching(const Options& options, const Judging& judging, Invocation& invocation)
      : options_(options),
        judge_(invocation, judging, options.out),
        settling_(options.settle),
        invocation_(invocation),
        progress_("watch", {.quiet = options.common.quiet}) {
    run_.out = options.out;
    judge_.pages = options.pages;
    if (!options.prometheus.empty()) gauges_.take_results(options.out);
  }

  // Until it is stopped; `once`: until what is there has had the time to settle.
  void go() {
    look();
    const double first_look = now();
    while (!stop_ && (!options_.once || (settling_.unsettled() > 0 && now() < first_look + options_.settle))) {
      const double left = first_look + options_.settle - now();
      rest(options_.once ? std::min(options_.interval, std::max(0.0, left)) : options_.interval);
      if (!stop_) look();
    }
    run_.interrupted = options_.once && stop_;  // a watch without an end has come to it when it is told to stop
  }
  const FleetRun& run() const { return run_; }
  std::size_t unsettled() const { return settling_.unsettled(); }

 private:
  double now() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

  void rest(double seconds) const {
    constexpr double slice = 0.05;  // [s] a signal is answered within it
    for (const double end = now() + seconds; !stop_ && now() < end;)
      std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(end - now(), 0.0, slice)));
  }

  // The gauges are written at every look: a collector knows a watch that is down by the age of its file.
  void look() {
    for (const std::string& name : settling_.settled(logs_in(options_.folder), now())) {
      if (stop_) return;
      judge(name);
    }
    if (!options_.prometheus.empty()) write_file(options_.prometheus, gauges_.text());
  }

  void judge(const std::string& file) {
    const FleetJudge::Outcome outcome = judge_.judge(options_.folder + "/" + file, result_name(file),
                                                     {.seed = options_.common.seed,
                                                      .threads = options_.common.threads,
                                                      .watch = {.stop = [this] { return stop_.load(); }}});
    run_.logs += outcome.end != RowEnd::interrupted;
    add(run_, outcome, progress_, invocation_.header(), judge_.header());
    if (outcome.end == RowEnd::made) tell(*outcome.judged);
    const std::string log = options_.folder + "/" + file;
    if (const auto& judged = outcome.judged)
      gauges_.take(log, {outcome.verdict, judged->fault, judged->error / judged->threshold, time_of_file(log)});
    gauges_.set_aside(run_.set_aside.size());
  }

  // As they come: a pipe or a journal is read line by line.
  void tell(const Verdict& verdict) const {
    if (!invocation_.prints_text()) return;
    const std::string text = report::text_of(*verdict.whole, {.colour = colour_wanted(), .written_to = ""});
    std::printf("%s\n", text.substr(0, text.find('\n')).c_str());
    std::fflush(stdout);
  }

  const Options& options_;
  FleetJudge judge_;
  Settling settling_;
  Invocation& invocation_;
  Progress progress_;
  FleetRun run_;
  ValveGauges gauges_;
  const std::atomic<bool>& stop_ = stop_on_interrupt(true);
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

int run_folder(const Options& options) {
  require_option(std::isfinite(options.settle) && options.settle >= 0, "--settle", "must be seconds, 0 or more",
                 "--settle 2");
  require_option(std::isfinite(options.interval) && options.interval > 0, "--interval", "must be seconds above 0",
                 "--interval 1");
  require_folder("--out", options.out);
  Invocation invocation("watch", options.common);
  std::vector<std::string> outputs;
  if (!options.prometheus.empty()) outputs.push_back(options.prometheus);
  invocation.check_files({options.params, options.baseline}, outputs);
  const Judging judging = read_judging(invocation, {options.params, options.baseline});
  report::Header& header = invocation.header();
  if (options.common.dry_run) (*header.settings)["logs"] = logs_in(options.folder).size();
  if (invocation.dry_run()) return ran;
  logs_in(options.folder);  // refused before the folder of the results is made
  Watching watching(options, judging, invocation);
  header.settings->update({{"folder", options.folder},
                           {"out", options.out},
                           {"settle", options.settle},
                           {"interval", options.interval},
                           {"once", options.once}});
  watching.go();
  if (options.once && watching.unsettled() > 0 && !watching.run().interrupted)
    invocation.note(
        {std::to_string(watching.unsettled()) + " files were still growing and are left for the next time"});
  invocation.finish(report::text_of(watching.run()), report::fleet_run_json(watching.run()));
  return code_of(watching.run(), options.exit_code);
}

int run(Options& options) {
  FollowOptions& follow = options.follow;
  const bool input = is_standard_stream(options.folder);
  require_option(options.folder.empty() != follow.source.empty(), "--follow",
                 "a folder, '-' or --follow FILE is watched, one of them", "servodx watch DIR, or --follow FILE");
  if (!input && follow.source.empty()) return run_folder(options);
  if (input) follow.source = options.folder;
  require_option(options.prometheus.empty(), "--prometheus", "is of a folder's logs", "leave it out");
  require_option(options.out.empty(), "--out", "is of a folder's logs", "leave it out; --events FILE keeps the events");
  follow.params = options.params, follow.baseline = options.baseline, follow.exit_code = options.exit_code;
  return servodx::follow(follow, options.common);
}

void add_follow_options(CLI::App& command, FollowOptions& follow) {
  command.add_option("--follow", follow.source, "log that grows (.csv), watched sample by sample")->type_name("FILE");
  command.add_option("--healthy", follow.healthy, "healthy logs that the alarm's limits rest on; else the baseline's")
      ->type_name("LOG");
  command.add_option("--alarms-per-hour", follow.alarms_per_hour, "false alarms of a healthy valve in an hour of log")
      ->type_name("RATE")
      ->capture_default_str();
  command.add_option("--state", follow.state, "written every second; a watch that was killed goes on from it")
      ->type_name("FILE");
  command.add_option("--events", follow.events, "a JSON line an event, appended; '-': to standard output")
      ->type_name("FILE");
  command.add_option("--until-idle", follow.until_idle, "end once nothing has come for so long [s]; 0: never")
      ->type_name("SECONDS")
      ->capture_default_str();
}

}  // namespace

void add_watch_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("watch", "Logs judged as they come: a folder's, or one that grows");
  command->add_option("DIR", options->folder,
                      "folder that logs come into (.csv .txt .tsv .dat .mat), or '-': a log on standard input");
  command->add_option("--out", options->out, "folder of the results, as of 'diagnose --list'; made if need be")
      ->type_name("DIR");
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("--baseline", options->baseline, "its baseline")->required()->type_name("BASE.json");
  command->add_option("--settle", options->settle, "for so long [s] a file's size and time must not change")
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_option("--interval", options->interval, "between two looks at the folder [s]")
      ->type_name("SECONDS")
      ->capture_default_str();
  command->add_flag("--once", options->once, "judge what is there, then end; what still grows is left");
  command->add_flag("--pages", options->pages, "also a page a log beside its result");
  command
      ->add_option("--prometheus", options->prometheus,
                   "text for Prometheus' textfile collector: verdict, error over threshold and last log of each valve")
      ->type_name("FILE.prom");
  command->add_flag("--exit-code", options->exit_code,
                    "end with 10 for a fault, 11 for unknown: the highest of the logs");
  add_follow_options(*command, options->follow);
  add_common_options(*command, options->common);
  command->footer(
      "A log that is refused leaves its reason in the folder of the results and the rest goes on. What was judged is\n"
      "known by its result: a watch that was killed goes on where it was. Ctrl-C or SIGTERM ends it, code 0.\n"
      "A log that grows is watched until its input is closed, or idle; Ctrl-C or SIGTERM ends it with code 130.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
