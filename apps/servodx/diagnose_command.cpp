// `servodx diagnose LOG...`: detect, classify, size. Each log alone, or as one (--pool).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "base/sha256.h"
#include "baseline_beside.h"
#include "commands.h"
#include "diagnose_list.h"
#include "fleet_judge.h"
#include "invocation.h"
#include "report/diagnose/diagnose_page.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/diagnose/diagnosis_text.h"
#include "report/diagnose/friction_words.h"
#include "report/diagnose/two_tests.h"
#include "report/shared/conditions.h"
#include "report/shared/json.h"
#include "report/shared/replay_part.h"
#include "report/shared/text_options.h"
#include "servodx/actions.h"
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/pages.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "servodx/watch.h"
#include "store/verdict_file.h"

namespace servodx {
namespace {

struct Options {
  CommonOptions common;
  std::vector<std::string> logs;
  std::string params, baseline, certificate, against;
  FaultSearch search = FaultSearch::by_fault;
  int population = 50;
  bool genetic() const { return search == FaultSearch::genetic; }
  bool pool = false, exit_by_action = false;
  ListOptions list;
  RunOptions run;
};

int code_of(Verdict::Kind verdict) {
  switch (verdict) {
    case Verdict::Kind::healthy:
      return ran;
    case Verdict::Kind::fault:
      return found_fault;
    case Verdict::Kind::unknown:
      return found_unknown;
  }
  return ran;
}

int code_of(ActionClass action) {
  switch (action) {
    case ActionClass::none:
      return ran;
    case ActionClass::abuse:
      return asks_abuse;
    case ActionClass::abnormal:
      return asks_abnormal;
    case ActionClass::critical:
      return asks_critical;
  }
  return ran;
}

std::vector<Verdict> judge_pool(const std::vector<Log>& logs, const Tuned& tuned, const RigFile& rig,
                                const Baseline& baseline, const DiagnoseOptions& options) {
  Verdict verdict = diagnose_pool(logs, tuned, rig, baseline, options);
  if (verdict.interrupted) return {};
  return {std::move(verdict)};
}

std::string friction_line(const Verdict& verdict) {
  return verdict.friction ? "  " + report::friction_in_words(*verdict.friction) + "\n" : "";
}

// `now`: of one verdict.
report::TwoTests since(const std::string& last_path, const store::StoredVerdict& last, const report::Header& header,
                       const report::Json& now) {
  report::Json whole = report::to_json(header);
  whole.update(now);
  return report::two_tests(last_path, last, store::verdict_of(whole));
}

// What a list would pass over in silence is refused.
void require_of_a_list(const Options& options) {
  require_option(!options.genetic(), "--search", "is of logs that are named one by one",
                 "name the logs in place of --list");
  require_option(options.population == Options().population, "--population", "is of '--search genetic'",
                 "leave it out, or name the logs in place of --list");
  require_option(!options.pool, "--pool", "makes one verdict, and a list one of each log",
                 "name the logs in place of --list, or leave it out");
  require_option(options.certificate.empty(), "--certificate", "certifies one verdict",
                 "name one log in place of --list");
  require_option(options.against.empty(), "--against", "is of one verdict", "name one log in place of --list");
  require_option(options.run.checkpoint.empty(), "--checkpoint", "is of logs that are named one by one",
                 "leave it out: the same call with --list goes on by itself");
}

void require_consistent(const Options& options) {
  require_option(options.logs.empty() != options.list.list.empty(), options.logs.empty() ? "LOG" : "--list",
                 options.logs.empty() ? "no log is named" : "logs are named one by one too",
                 "name the logs, or a file that lists them with --list FILE --out DIR");
  if (!options.list.list.empty()) require_of_a_list(options);
  const bool one = options.logs.size() == 1 || options.pool || !options.list.list.empty();
  require_option(options.certificate.empty() || one, "--certificate", "certifies one verdict",
                 "name one log, or add --pool");
  require_option(options.against.empty() || one, "--against", "is of one verdict", "name one log, or add --pool");
}

std::vector<std::string> truths_beside(const std::vector<Log>& logs) {
  std::vector<std::string> out;
  for (const Log& log : logs) out.push_back(truth_beside(log));
  return out;
}

// Beside the rate what was asked for otherwise than usual.
report::Json settings_of(const Options& options, const Baseline& baseline) {
  report::Json out = {{"false_alarm", baseline.asked}};
  if (!options.list.explain_unknown) out["explain_unknown"] = false;
  if (options.pool) out["pool"] = true;
  if (!options.against.empty()) out["against"] = options.against;
  if (options.genetic()) out.update({{"search", "genetic"}, {"population", options.population}});
  return out;
}

int run(const Options& options) {
  require_consistent(options);
  if (!options.list.list.empty())
    return diagnose_list(options.common, options.run, options.list, options.params, options.baseline);
  Invocation invocation("diagnose", options.common, options.run);
  auto inputs = options.logs;
  inputs.insert(inputs.end(), {options.params, options.baseline});
  for (const std::string& more : {options.list.actions, options.certificate, options.against})
    if (!more.empty()) inputs.push_back(more);
  invocation.check_files(inputs, {});
  const RigFile rig = invocation.rig();
  const Tuned tuned = invocation.tuned(options.params);
  const Baseline baseline = baseline_beside(invocation, options.baseline, rig);
  require_same_table(baseline, tuned);
  std::vector<Log> logs;
  for (const std::string& path : options.logs) logs.push_back(invocation.log(path, rig));
  report::Header& header = invocation.header();
  report::add_to_head(header.head, logs);
  header.inputs.push_back({options.baseline, baseline.sha256});
  if (!options.list.actions.empty())
    header.inputs.push_back({options.list.actions, sha256_of_file(options.list.actions)});

  const auto certificate = invocation.certificate(options.certificate);
  std::optional<store::StoredVerdict> last;
  if (!options.against.empty()) {
    last = store::read_one_verdict(options.against);
    header.inputs.push_back({options.against, sha256_of_file(options.against)});
  }

  std::vector<std::string> truths = invocation.wants_report() ? truths_beside(logs) : std::vector<std::string>{};

  const Actions actions = actions_of(options.list.actions);
  *header.settings = settings_of(options, baseline);
  invocation.tell_of_long_fits(logs);
  if (invocation.dry_run()) return ran;

  const Watch watch = invocation.watch();
  const DiagnoseOptions how{.seed = options.common.seed,
                            .threads = options.common.threads,
                            .watch = watch,
                            .actions = actions,
                            .search = options.search,
                            .population = options.population,
                            .explain_unknown = options.list.explain_unknown};
  const std::vector<Verdict> results =
      options.pool ? judge_pool(logs, tuned, rig, baseline, how) : diagnose_each(logs, tuned, rig, baseline, how);
  std::string text;
  int worst = ran;
  for (const Verdict& v : results) {
    header.simulations += v.simulations;
    header.failed_simulations += v.failed_simulations;
    invocation.note(v.notes);
    text += (text.empty() ? "" : "\n") +
            report::text_of(*v.whole, {.colour = colour_wanted(), .written_to = "", .call = header.call}) +
            friction_line(v);
    worst = std::max(worst, options.exit_by_action ? code_of(v.action_class) : code_of(v.kind));
  }
  if (results.size() < (options.pool ? 1 : logs.size()))
    invocation.note({fmt::format("interrupted: {} of {} logs were judged", results.size(), logs.size())});
  if (watch.stopped()) invocation.note_how_to_go_on();
  report::Json json = report::diagnose_json(results);
  report::BesideVerdict beside;
  if (last && results.size() == 1) {
    beside.last = since(options.against, *last, header, json);
    text += "\n" + report::text_of(*beside.last);
    json["last_test"] = report::to_json(*beside.last);
  }
  if (invocation.wants_report()) {
    if (results.size() == 1) beside.bodes = bodes_of(results.front(), tuned, rig);
    truths.resize(results.size());
    invocation.write_report(
        report::diagnose_page(header, results, baseline, replays_of(results, logs, tuned, rig, report::most_replays),
                              truths, {certificate ? &*certificate : nullptr, invocation.manifest()}, beside));
  }
  invocation.finish(text, json);
  const bool tells = options.list.exit_code || options.exit_by_action;
  return watch.stopped() ? interrupted : tells ? worst : ran;
}

}  // namespace

void add_diagnose_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("diagnose", "Detect, name and size faults; each log alone, or all as one");
  command->add_option("LOG", options->logs, "rig logs, CSV");
  CLI::Option* list =
      command
          ->add_option("--list", options->list.list,
                       "in place of LOG: a file with one log a line, relative to the working directory ('#': a "
                       "comment; '-': standard input)")
          ->type_name("FILE");
  command->add_option("--out", options->list.out, "with --list: folder of the results, one JSON a log; made if need be")
      ->type_name("DIR")
      ->needs(list);
  command
      ->add_option("--chunk", options->list.chunk,
                   "with --list: every N-th log from the I-th on, as one of N processes on the same folder")
      ->type_name("I/N")
      ->needs(list)
      ->capture_default_str();
  command->add_flag("--pages", options->list.pages, "with --list: also a page a log beside its result")->needs(list);
  add_certificate_option(*command, options->certificate);
  command
      ->add_option("--against", options->against,
                   "the last test of this valve, as --json wrote it: what has become of it since")
      ->type_name("LAST.json");
  command->add_option("--params", options->params, "tuned table")->required()->type_name("TUNED");
  command->add_option("--baseline", options->baseline, "its baseline")->required()->type_name("BASE.json");
  command->add_flag("--exit-code", options->list.exit_code,
                    "end with 10 for a fault, 11 for unknown: the highest of the logs");
  command->add_flag("--pool", options->pool, "the logs are of one valve in one state: one verdict for all of them");
  command
      ->add_option("--actions", options->list.actions,
                   "TOML file of what to do by label, in place of the program's: clogged_filter = \"abnormal: flush\"")
      ->type_name("FILE");
  command
      ->add_option("--search", options->search,
                   "where a fault's fit begins: by-fault, from the severities that screen best; genetic, from a search "
                   "over sub-groups, one a failure mode")
      ->transform(CLI::CheckedTransformer(
          std::map<std::string, FaultSearch>{{"by-fault", FaultSearch::by_fault}, {"genetic", FaultSearch::genetic}}))
      ->default_str("by-fault");
  command->add_option("--population", options->population, "with --search genetic: individuals of each sub-group")
      ->type_name("N")
      ->capture_default_str();
  command
      ->add_flag("--exit-by-action", options->exit_by_action,
                 "end with 14 where the machine has to stop, 13 to call service, 12 to change its use: the most urgent "
                 "of the logs")
      ->excludes(list);
  command->add_flag("!--no-explain", options->list.explain_unknown,
                    "do not ask what stands first where no fault explains a log (saves seconds a log)");
  add_run_options(*command, options->run);
  add_common_options(*command, options->common);
  command->footer(
      "With --list a result that is there is kept where log, table, baseline, rig file, actions, options and program\n"
      "are the same; a log that is refused leaves its reason in DIR and the rest goes on: exit code 3, where neither\n"
      "10 nor 11 is due.");
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace servodx
