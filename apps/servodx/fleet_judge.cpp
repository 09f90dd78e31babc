#include "fleet_judge.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "baseline_beside.h"
#include "build.h"
#include "fleet/fleet_verdict.h"
#include "fleet/result_file.h"
#include "list_run.h"
#include "report/diagnose/diagnose_page.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/fleet/fleet.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/pages.h"

namespace servodx {
namespace {

FleetVerdict standing(Verdict::Kind verdict) {
  switch (verdict) {
    case Verdict::Kind::healthy:
      return FleetVerdict::healthy;
    case Verdict::Kind::fault:
      return FleetVerdict::fault;
    case Verdict::Kind::unknown:
      return FleetVerdict::unknown;
  }
  return FleetVerdict::none;
}

}  // namespace

Judging read_judging(Invocation& invocation, const JudgingFiles& files, bool explain_unknown) {
  RigFile rig = invocation.rig();
  Tuned tuned = invocation.tuned(files.params);
  Baseline baseline = baseline_beside(invocation, files.baseline, rig);
  Judging judging{std::move(rig), std::move(tuned), std::move(baseline), actions_of(files.actions), explain_unknown};
  require_same_table(judging.baseline, judging.tuned);
  judging.behind_log.push_back({files.baseline, judging.baseline.sha256});
  if (!files.actions.empty()) judging.behind_log.push_back({files.actions, sha256_of_file(files.actions)});
  report::Header& header = invocation.header();
  header.inputs.insert(header.inputs.end(), judging.behind_log.begin(), judging.behind_log.end());
  *header.settings = {{"false_alarm", judging.baseline.asked}};
  if (!explain_unknown) header.settings->update({{"explain_unknown", false}});
  return judging;
}

FleetJudge::FleetJudge(const Invocation& invocation, const Judging& judging, const std::string& out)
    : judging_(judging), of_call_(invocation.header()), folder_(out) {
  of_call_.inputs.resize(of_call_.inputs.size() - judging.behind_log.size());
  of_call_.command = "diagnose";
  of_call_.commit = build_commit;
}

void FleetJudge::begin(const std::string& log) {
  header_ = of_call_;
  header_.inputs.push_back({log, sha256_of_file(log)});
  header_.inputs.insert(header_.inputs.end(), judging_.behind_log.begin(), judging_.behind_log.end());
}

bool FleetJudge::stands(const std::string& name, Outcome& outcome) const {
  ResultBasis basis{header_.version, header_.commit, header_.seed, header_.settings->dump(), {}};
  for (const report::InputFile& input : header_.inputs) basis.inputs.push_back(input.sha256);
  if (!pages || folder_.has_page(name)) outcome.verdict = standing_verdict(folder_.result_path(name), basis);
  return outcome.verdict != FleetVerdict::none;
}

FleetJudge::Outcome FleetJudge::set_aside(const std::string& log, const std::string& name, const InputError& error) {
  folder_.write_refusal(name, report::dump(header_, report::refusal_json(log, error)));
  return {.end = RowEnd::set_aside, .refusal = report::set_aside_of(error)};
}

// There before the result is: so a result that stands has its page.
void FleetJudge::write_page(const std::string& name, const Verdict& verdict, const Log& log) const {
  const std::vector verdicts = {verdict};
  const auto replays = replays_of(verdicts, {log}, judging_.tuned, judging_.rig, 1);
  write_file(folder_.page_path(name), report::diagnose_page(header_, verdicts, judging_.baseline, replays).html());
}

void FleetJudge::complete_header(const Verdict& verdict) {
  header_.simulations += verdict.simulations;
  header_.failed_simulations += verdict.failed_simulations;
  for (const std::string& note : texts_of(verdict.notes))
    if (std::find(header_.notes.begin(), header_.notes.end(), note) == header_.notes.end())
      header_.notes.push_back(note);
}

FleetJudge::Outcome FleetJudge::judge(const std::string& path, const std::string& name, DiagnoseOptions options) {
  options.actions = judging_.actions, options.explain_unknown = judging_.explain_unknown;
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  const auto refusal = refusal_of(path, [&] {
    header_ = of_call_;
    begin(path);
    if (stands(name, outcome)) {
      outcome.end = RowEnd::stood;
      return;
    }
    const Log log = read_log(path, judging_.rig);
    header_.inputs[of_call_.inputs.size()].sha256 = log.sha256;
    Verdict verdict = diagnose(log, judging_.tuned, judging_.rig, judging_.baseline, options);
    if (verdict.interrupted) {
      outcome.end = RowEnd::interrupted;
      return;
    }
    complete_header(verdict);
    outcome.judged = std::move(verdict);
    header_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (pages) write_page(name, *outcome.judged, log);
  });
  if (refusal) return set_aside(path, name, *refusal);
  if (outcome.end != RowEnd::made) return outcome;
  outcome.verdict = standing(outcome.judged->kind);
  if (!pages) folder_.drop_page(name);  // it shows what an earlier run found
  folder_.write_result(name, report::dump(header_, report::diagnose_json(std::vector{*outcome.judged})));
  return outcome;
}

void add(FleetRun& run, const FleetJudge::Outcome& outcome, Progress& progress, report::Header& of_call,
         const report::Header& of_log) {
  run.count(outcome.verdict);
  count(run, outcome.end, outcome.refusal, progress);
  if (outcome.end != RowEnd::made) return;
  of_call.simulations += of_log.simulations;
  of_call.failed_simulations += of_log.failed_simulations;
}

int code_of(const FleetRun& run, bool exit_code) {
  if (exit_code && !run.interrupted && run.unknown > 0) return found_unknown;
  if (exit_code && !run.interrupted && run.fault > 0) return found_fault;
  return code_of(run);
}

}  // namespace servodx
