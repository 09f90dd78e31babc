#include "fleet_judge.h"

#include <algorithm>
#include <chrono>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/sha256.h"
#include "baseline_beside.h"
#include "fleet/fleet_verdict.h"
#include "fleet/result_file.h"
#include "list_run.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/fleet/fleet.h"
#include "servodx/log.h"
#include "servodx/note.h"

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

Judging read_judging(Invocation& invocation, const std::string& params, const std::string& baseline) {
  RigFile rig = invocation.rig();
  Tuned tuned = invocation.tuned(params);
  Baseline judged = baseline_beside(invocation, baseline, rig);
  Judging judging{std::move(rig), std::move(tuned), std::move(judged)};
  require_same_table(judging.baseline, judging.tuned);
  invocation.header().inputs.push_back({baseline, judging.baseline.sha256});
  *invocation.header().settings = {{"false_alarm", judging.baseline.asked}};
  return judging;
}

FleetJudge::FleetJudge(const Invocation& invocation, const Judging& judging, const std::string& out)
    : judging_(judging), of_call_(invocation.header()), folder_(out), baseline_(of_call_.inputs.back()) {
  of_call_.inputs.pop_back();  // a result names its log between table and baseline
  of_call_.command = "diagnose";
}

void FleetJudge::begin(const std::string& log) {
  header_ = of_call_;
  header_.inputs.push_back({log, sha256_of_file(log)});
  header_.inputs.push_back(baseline_);
}

bool FleetJudge::stands(const std::string& name, Outcome& outcome) const {
  ResultBasis basis{header_.version, header_.seed, {}};
  for (const report::InputFile& input : header_.inputs) basis.inputs.push_back(input.sha256);
  outcome.verdict = standing_verdict(folder_.result_path(name), basis);
  return outcome.verdict != FleetVerdict::none;
}

FleetJudge::Outcome FleetJudge::set_aside(const std::string& log, const std::string& name, const InputError& error) {
  folder_.write_refusal(name, report::dump(header_, report::refusal_json(log, error)));
  return {.end = RowEnd::set_aside, .refusal = report::set_aside_of(error)};
}

void FleetJudge::complete_header(const Verdict& verdict) {
  header_.simulations += verdict.simulations;
  header_.failed_simulations += verdict.failed_simulations;
  for (const std::string& note : texts_of(verdict.notes))
    if (std::find(header_.notes.begin(), header_.notes.end(), note) == header_.notes.end())
      header_.notes.push_back(note);
}

FleetJudge::Outcome FleetJudge::judge(const std::string& path, const std::string& name,
                                      const DiagnoseOptions& options) {
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
    header_.inputs[header_.inputs.size() - 2].sha256 = log.sha256;
    Verdict verdict = diagnose(log, judging_.tuned, judging_.rig, judging_.baseline, options);
    if (verdict.interrupted) {
      outcome.end = RowEnd::interrupted;
      return;
    }
    complete_header(verdict);
    outcome.judged = std::move(verdict);
    header_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (beside) beside(name, *outcome.judged, log);
  });
  if (refusal) return set_aside(path, name, *refusal);
  if (outcome.end != RowEnd::made) return outcome;
  outcome.verdict = standing(outcome.judged->kind);
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
