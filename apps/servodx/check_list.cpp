#include "check_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>
#include <utility>

#include "base/progress.h"
#include "base/sha256.h"
#include "fleet/check_list.h"
#include "fleet/gather.h"
#include "fleet/log_list.h"
#include "fleet/result_file.h"
#include "fleet/run.h"
#include "list_run.h"
#include "report/check/check_report.h"
#include "report/fleet/fleet.h"
#include "result_folder.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/trend.h"
#include "servodx/tune.h"

namespace servodx {
namespace {

using Tables = std::map<std::string, Tuned>;  // by path

// The checks of a list, each as `check LOG` does it.
class ListedChecks {
 public:
  ListedChecks(const CheckListOptions& options, const report::Header& of_call, RigFile rig, const Tables& tables,
               std::optional<History> history)
      : options_(options),
        of_call_(of_call),
        rig_(std::move(rig)),
        tables_(tables),
        history_(std::move(history)),
        folder_(options.out.empty() ? std::nullopt : std::optional<ResultFolder>(options.out)) {}

  struct Outcome {
    RowEnd end = RowEnd::made;
    std::optional<SetAside> refusal = {};   // set aside
    std::vector<std::string> notices = {};  // for the whole call
    long simulations = 0, failed_simulations = 0;
  };
  // Throws where history or result cannot be written or read: no log can mend that.
  Outcome check(const CheckRow& row);

 private:
  Outcome set_aside(const CheckRow& row, const report::Header& header, const InputError& error) const;
  void write_result(const CheckRow& row, report::Header& header, const Checked& checked) const;
  RowEnd record(const CheckRow& row, const History::Use& use, const Checked& checked, const Tuned& tuned);
  bool holds(const CheckRow& row, const std::string& sha256, const Tuned& tuned) const {
    return history_ && history_->holds(row.valve, row.hours, sha256, tuned);
  }

  const CheckListOptions& options_;
  report::Header of_call_;
  RigFile rig_;
  const Tables& tables_;
  std::optional<History> history_;  // a new one is made only when there is something to store
  std::optional<ResultFolder> folder_;
};

std::string name_of_result(const CheckRow& row) { return result_name(row.log, use_of(row)); }

void note(report::Header& header, const std::vector<std::string>& notices) {
  for (const std::string& notice : notices)
    if (std::find(header.notes.begin(), header.notes.end(), notice) == header.notes.end())
      header.notes.push_back(notice);
}

ListedChecks::Outcome ListedChecks::set_aside(const CheckRow& row, const report::Header& header,
                                              const InputError& error) const {
  if (folder_) folder_->write_refusal(name_of_result(row), report::dump(header, report::refusal_json(row.log, error)));
  return {.end = RowEnd::set_aside, .refusal = report::set_aside_of(error)};
}

void ListedChecks::write_result(const CheckRow& row, report::Header& header, const Checked& checked) const {
  header.simulations = checked.simulations, header.failed_simulations = checked.failed_simulations;
  note(header, texts_of(checked.notes));
  if (folder_) folder_->write_result(name_of_result(row), report::dump(header, report::check_json(*checked.whole)));
}

// Another process may have been quicker.
RowEnd ListedChecks::record(const CheckRow& row, const History::Use& use, const Checked& checked, const Tuned& tuned) {
  if (!history_) history_ = History::open_or_make(options_.history);
  try {
    history_->record(row.valve, use, checked, tuned);
    return RowEnd::made;
  } catch (const InputError&) {
    if (holds(row, checked.sha256, tuned)) return RowEnd::stood;
    throw;
  }
}

ListedChecks::Outcome ListedChecks::check(const CheckRow& row) {
  const auto start = std::chrono::steady_clock::now();
  const Tuned& tuned = tables_.at(row.params);
  report::Header header = of_call_;
  *header.settings = check_settings(row.valve, row.hours, options_.check.model, options_.history);
  header.inputs.push_back({tuned.table.path, tuned.table.sha256});
  note(header, texts_of(tuned.notes));
  std::string sha256;
  if (const auto refusal = refusal_of(row.log, [&] { sha256 = sha256_of_file(row.log); }))
    return set_aside(row, header, *refusal);
  header.inputs.push_back({row.log, sha256});
  if (holds(row, sha256, tuned)) {
    if (folder_) folder_->drop_refusal(name_of_result(row));
    return {.end = RowEnd::stood};
  }
  const History::Use use{row.hours, row.cycles, row.serial.empty() ? rig_.serial : row.serial};
  const Before before = before_check(history_, row.valve, use.serial);
  note(header, before.notices);
  CheckOptions how = options_.check;
  how.last = before.last;
  std::optional<Checked> checked;
  const auto refusal = refusal_of(row.log, [&] {
    const Log log = read_log(row.log, rig_);
    header.inputs.back().sha256 = log.sha256;
    checked = servodx::check(log, tuned, rig_, how);
  });
  if (refusal) return set_aside(row, header, *refusal);
  header.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  // The result first: what the history holds is not made again.
  write_result(row, header, *checked);
  return {.end = record(row, use, *checked, tuned),
          .notices = before.notices,
          .simulations = checked->simulations,
          .failed_simulations = checked->failed_simulations};
}

// Each table once, noted among the inputs of the call.
Tables read_tables(Invocation& invocation, const CheckList& list) {
  Tables tables;
  for (const CheckRow& row : list.rows)
    if (!tables.contains(row.params)) tables.emplace(row.params, invocation.tuned(row.params));
  return tables;
}

std::vector<std::string> paths_of(const CheckList& list, std::string CheckRow::*path) {
  std::vector<std::string> paths;
  for (const CheckRow& row : list.rows) paths.push_back(row.*path);
  return paths;
}

std::vector<std::string> notices_of(const CheckList& list) {
  if (list.passed_over.empty()) return {};
  return {fmt::format("columns of the list that no check takes: {}", fmt::join(list.passed_over, ", "))};
}

CheckRun check_all(const CheckList& list, ListedChecks& checks, const CommonOptions& common,
                   const CheckListOptions& options, Invocation& invocation) {
  CheckRun run;
  run.history = options.history, run.out = options.out, run.logs = list.rows.size();
  run_list("check", run, common.quiet, [&](std::size_t place, Progress& progress, const Tell&) {
    const ListedChecks::Outcome outcome = checks.check(list.rows[place]);
    count(run, outcome.end, outcome.refusal, progress);
    invocation.note(outcome.notices);
    invocation.header().simulations += outcome.simulations;
    invocation.header().failed_simulations += outcome.failed_simulations;
  });
  return run;
}

}  // namespace

Before before_check(const std::optional<History>& history, const std::string& valve, const std::string& serial) {
  if (!history) return {};
  Before before{history->tracked(valve), {}};
  if (const std::string was = history->serial(valve); !was.empty() && !serial.empty() && was != serial)
    before.notices.push_back(
        fmt::format("'{}' was serial {} and is {} now: if the valve was swapped, "
                    "'servodx history event valve_swapped' starts its trends again",
                    valve, was, serial));
  return before;
}

report::Json check_settings(const std::string& valve, double at, const std::string& model, const std::string& history) {
  return {{"valve", valve}, {"at", at}, {"model", model}, {"history", history}};
}

int check_list(const CommonOptions& common, const CheckListOptions& options) {
  require_option(common.report.empty() && common.pdf.empty(), common.report.empty() ? "--pdf" : "--report",
                 "a list has no page of its own",
                 "'servodx trend --history " + options.history + " --all --report FILE.html' shows the valves");
  if (!options.out.empty()) require_folder("--out", options.out);
  options.check.validate();
  const CheckList list = read_check_list(options.list, options.params);
  Invocation invocation("check", common);
  std::vector<std::string> inputs = paths_of(list, &CheckRow::log);
  for (const std::string& table : paths_of(list, &CheckRow::params)) inputs.push_back(table);
  if (!is_standard_input(options.list)) inputs.push_back(options.list);
  invocation.check_files(inputs, {options.history});
  RigFile rig = invocation.rig();
  const report::Header of_row = invocation.header();
  invocation.note(notices_of(list));
  const Tables tables = read_tables(invocation, list);
  std::optional<History> history;
  if (History::there(options.history)) history = History::open(options.history);
  report::Header& header = invocation.header();
  // What can be read but once has no hash.
  std::error_code ignored;
  if (std::filesystem::is_regular_file(options.list, ignored))
    header.inputs.push_back({options.list, sha256_of_file(options.list)});
  *header.settings = {
      {"list", options.list}, {"out", options.out}, {"model", options.check.model}, {"history", options.history}};
  if (common.dry_run) rehearse_list(paths_of(list, &CheckRow::log), rig, header);
  if (invocation.dry_run()) return ran;

  ListedChecks checks(options, of_row, std::move(rig), tables, std::move(history));
  const CheckRun run = check_all(list, checks, common, options, invocation);
  invocation.note(interrupt_notice(run));
  invocation.finish(report::text_of(run), report::check_run_json(run));
  return code_of(run);
}

}  // namespace servodx
