#include "fleet_judge.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/sha256.h"
#include "baseline_beside.h"
#include "diagnose/decide.h"
#include "door/baseline_parts.h"
#include "fleet/fleet_verdict.h"
#include "report/fleet.h"
#include "servodx/log.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

FleetVerdict standing(VerdictKind verdict) {
  switch (verdict) {
    case VerdictKind::healthy:
      return FleetVerdict::healthy;
    case VerdictKind::fault:
      return FleetVerdict::fault;
    case VerdictKind::unknown:
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
  invocation.header().inputs.push_back({baseline, judging.baseline.parts->sha256});
  invocation.header().settings = {{"false_alarm", judging.baseline.asked}};
  return judging;
}

void require_folder(const std::string& option, const std::string& folder) {
  std::error_code ignored;
  require_option(!folder.empty(), option, "is required: the folder of the results", option + " results");
  if (fs::is_directory(folder, ignored)) return;
  const fs::path parent = fs::absolute(folder).lexically_normal().parent_path();
  require_option(!fs::exists(folder, ignored), option, "'" + folder + "' is no folder", "name a folder");
  require_option(fs::is_directory(parent, ignored), option, "there is no folder '" + parent.string() + "'",
                 "make that folder, or name another");
}

FleetJudge::FleetJudge(const Invocation& invocation, const Judging& judging, std::string out)
    : judging_(judging), of_call_(invocation.header()), out_(std::move(out)), baseline_(of_call_.inputs.back()) {
  of_call_.inputs.pop_back();  // a result names its log between table and baseline
  of_call_.command = "diagnose";
  std::error_code failed;  // another process may make it at the same time
  fs::create_directory(out_, failed);
  if (!fs::is_directory(out_))
    throw InputError({out_, 0, ""}, "cannot be made: " + failed.message(), "make the folder or name another");
}

void FleetJudge::begin(const std::string& log) {
  header_ = of_call_;
  header_.inputs.push_back({log, sha256_of_file(log)});
  header_.inputs.push_back(baseline_);
}

bool FleetJudge::stands(const std::string& name, Outcome& outcome) const {
  ResultBasis basis{header_.version, header_.seed, {}};
  for (const report::InputFile& input : header_.inputs) basis.inputs.push_back(input.sha256);
  outcome.verdict = standing_verdict(result_path(name), basis);
  return outcome.verdict != FleetVerdict::none;
}

FleetJudge::Outcome FleetJudge::set_aside(const std::string& log, const std::string& name, const InputError& error) {
  write_file(refusal_path(name), report::dump(header_, report::refusal_json(log, error)));
  std::error_code ignored;
  for (const std::string& was : {result_path(name), page_path(name)}) fs::remove(was, ignored);
  return {.end = End::set_aside, .refusal = report::set_aside_of(error)};
}

void FleetJudge::complete_header(const Diagnosis& d) {
  header_.simulations += d.assessment.simulations;
  header_.failed_simulations += d.assessment.failed_simulations;
  for (const std::string& note : d.assessment.notes)
    if (std::find(header_.notes.begin(), header_.notes.end(), note) == header_.notes.end())
      header_.notes.push_back(note);
}

FleetJudge::Outcome FleetJudge::judge(const std::string& path, const std::string& name,
                                      const DiagnoseOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  Outcome outcome;
  try {
    header_ = of_call_;
    begin(path);
    if (stands(name, outcome)) {
      outcome.end = End::stood;
      return outcome;
    }
    const Log log = read_log(path, judging_.rig);
    header_.inputs[header_.inputs.size() - 2].sha256 = log.sha256;
    const Verdict verdict = diagnose(log, judging_.tuned, judging_.rig, judging_.baseline, options);
    if (verdict.interrupted) return {.end = End::interrupted};
    outcome.diagnosis = *verdict.whole;
    outcome.fault = verdict.fault, outcome.error_ratio = verdict.error / verdict.threshold;
    complete_header(*outcome.diagnosis);
    header_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (beside) beside(name, *outcome.diagnosis, log);
  } catch (const InputError& error) {
    return set_aside(path, name, error);
  } catch (const std::exception& failure) {
    return set_aside(path, name, {{path, 0, ""}, std::string("failed inside: ") + failure.what(), "report it"});
  }
  outcome.verdict = standing(outcome.diagnosis->verdict);
  write_file(result_path(name), report::dump(header_, report::diagnose_json({*outcome.diagnosis})));
  std::error_code ignored;
  fs::remove(refusal_path(name), ignored);
  return outcome;
}

void add(FleetRun& run, const FleetJudge::Outcome& outcome, Progress& progress, report::Header& of_call,
         const report::Header& of_log) {
  run.count(outcome.verdict);
  switch (outcome.end) {
    case FleetJudge::End::judged:
      ++run.judged;
      of_call.simulations += of_log.simulations;
      of_call.failed_simulations += of_log.failed_simulations;
      break;
    case FleetJudge::End::stood:
      ++run.stood;
      break;
    case FleetJudge::End::set_aside:
      run.set_aside.push_back(*outcome.refusal);
      progress.say("set aside: " + report::words_of(*outcome.refusal));
      break;
    case FleetJudge::End::interrupted:
      run.interrupted = true;
      break;
  }
}

int code_of(const FleetRun& run, bool exit_code) {
  if (run.interrupted) return interrupted;
  if (exit_code && run.unknown > 0) return found_unknown;
  if (exit_code && run.fault > 0) return found_fault;
  return run.set_aside.empty() ? ran : some_set_aside;
}

}  // namespace servodx
