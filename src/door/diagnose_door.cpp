// The front door of `diagnose`: the verdict in words and numbers that need nothing of the library's inside.
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/parts_done.h"
#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/lateral_force.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "door/stands_first.h"
#include "explain/explain.h"
#include "faults/fault.h"
#include "fit/tuned_state.h"
#include "report/diagnose/diagnosis_json.h"
#include "report/diagnose/diagnosis_words.h"
#include "report/diagnose/next_calls.h"
#include "report/diagnose/verdict_words.h"
#include "report/shared/json.h"
#include "servodx/baseline.h"
#include "servodx/diagnose.h"
#include "servodx/error.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/operating_point.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "servodx/tuned_by.h"
#include "signals/fingerprint.h"
#include "simulate/side_by_side.h"
#include "store/baseline_parts.h"

namespace servodx {
namespace {

Verdict::Kind kind_of(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::healthy:
      return Verdict::Kind::healthy;
    case VerdictKind::fault:
      return Verdict::Kind::fault;
    case VerdictKind::unknown:
      return Verdict::Kind::unknown;
  }
  return Verdict::Kind::unknown;
}

std::optional<Verdict::Suspicion> suspicion_of(const Diagnosis& d) {
  if (!d.suspicion) return {};
  const Suspicion& s = *d.suspicion;
  return Verdict::Suspicion{
      report::label_of(s.fault), {s.severity, s.lower, s.upper, report::unit_of(s.fault)}, s.rate, s.logs_needed};
}

std::optional<BeyondFaults> explain_unknown(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                                            const Baseline& baseline, const DiagnoseOptions& options) {
  ExplainOptions ask{.seed = options.seed, .threads = options.threads, .level = baseline.asked};
  ask.watch = options.watch;
  ask.watch.progress = nullptr;  // the diagnosis has its own
  const ExplainResult r = explain_logs(logs, tuned.table, rig, &causes_of(baseline), ask);
  if (r.interrupted) return {};
  return stands_first(r);
}

// Where the logs that tuned the table were recorded: `baseline` keeps them among those of other tests.
std::vector<OperatingPoint> tuning_points(const DetectionBaseline& baseline, const Table& tuned) {
  std::vector<OperatingPoint> out;
  const TunedState state = tuned_state(tuned);
  for (const DetectionBaseline::Score& s : baseline.others)
    if (std::any_of(state.by.begin(), state.by.end(), [&](const TunedBy& by) {
          return is_same_log({by.sha256, by.content}, {s.sha256, s.content});
        }))
      out.push_back(s.point);
  return out;
}

Verdict interrupted_verdict(const Assessment& assessment) {
  Verdict out;
  out.log = assessment.log;
  out.interrupted = true;
  out.simulations = assessment.simulations, out.failed_simulations = assessment.failed_simulations;
  return out;
}

Verdict verdict_of(Diagnosis d) {
  Verdict out;
  out.log = d.log;
  out.kind = kind_of(d.verdict);
  out.error = d.error, out.threshold = d.threshold, out.p_value = d.p_value;
  if (d.fault) {
    out.fault = report::label_of(d.fault);
    out.severity = {d.severity.value, d.severity.lower, d.severity.upper, report::unit_of(d.fault)};
  }
  for (const NamedFault& f : d.faults)
    out.faults.push_back({report::label_of(f.fault),
                          f.probability,
                          {f.severity, f.lower, f.upper, report::unit_of(f.fault)},
                          report::channel_of(f)});
  out.probabilities = report::labelled_probabilities(d);
  out.ambiguous_with = report::ambiguous_labels(d);
  out.separating_test = report::separating_test_of(d);
  out.onset = d.onset;
  out.suspicion = suspicion_of(d);
  for (const Detectable& f : d.detectable)
    out.detectable[report::label_of(f.fault)] = {f.severity, report::unit_of(f.fault)};
  out.beyond = d.beyond;
  out.friction = d.friction;
  out.action_class = d.action.of, out.action = d.action.text;
  for (const MovedRow& row : d.moved) out.parameters.push_back(row);
  out.channels = d.assessment.channels;
  out.notes = d.assessment.notes;
  out.simulations = d.assessment.simulations, out.failed_simulations = d.assessment.failed_simulations;
  out.whole = std::make_shared<Diagnosis>(std::move(d));
  return out;
}

}  // namespace

std::string name_of(Verdict::Kind kind) {
  switch (kind) {
    case Verdict::Kind::healthy:
      return report::word_of(VerdictKind::healthy);
    case Verdict::Kind::fault:
      return report::word_of(VerdictKind::fault);
    case Verdict::Kind::unknown:
      return report::word_of(VerdictKind::unknown);
  }
  return "";
}

std::string json_of(const Verdict& verdict) { return verdict.whole ? report::to_json(*verdict.whole).dump(2) : "null"; }

Verdict diagnose_pool(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                      const DiagnoseOptions& options) {
  options.validate();
  if (logs.empty()) throw InputError({}, "no log is given", "give the logs of one valve in one state");
  const std::optional<Note> of_baseline = require_same_table(baseline, tuned);
  Assessment assessment = assess_pool(logs, tuned.table, rig, options);
  if (options.watch.stopped()) return interrupted_verdict(assessment);
  if (of_baseline) assessment.notes.push_back(*of_baseline);
  for (Note& note : notes_beside(baseline, rig, logs)) assessment.notes.push_back(std::move(note));
  Diagnosis d = judge(std::move(assessment), parts_of(baseline).detection);
  set_beside_tuning(d.conditions, tuning_points(parts_of(baseline).detection, tuned.table));
  const bool asks = d.doubt == Doubt::no_fault && options.explain_unknown;
  if (asks && !parts_of(baseline).causes)
    d.assessment.notes.push_back(
        {Note::Kind::no_causes, "the baseline says nothing of causes, so explain was not asked what stands first"});
  else if (asks) {
    d.beyond = explain_unknown(logs, tuned, rig, baseline, options);
    if (options.watch.stopped()) return interrupted_verdict(d.assessment);
  }
  d.friction = friction_beside_force(d, tuned.table, rig);
  const auto own = options.actions.find(report::action_label_of(d));
  d.action = own == options.actions.end() ? options.actions.at(report::name_of(d)) : own->second;
  return verdict_of(std::move(d));
}

Verdict diagnose(const Log& log, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                 const DiagnoseOptions& options) {
  return diagnose_pool({log}, tuned, rig, baseline, options);
}

Verdict diagnose_window(const Log& window, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                        const DiagnoseOptions& options) {
  options.validate();
  require_same_table(baseline, tuned);
  Assessment assessment = assess(window, tuned.table, rig, options);
  if (options.watch.stopped()) return interrupted_verdict(assessment);
  return verdict_of(judge(std::move(assessment), parts_of(baseline).detection));
}

std::vector<Verdict> diagnose_each(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig,
                                   const Baseline& baseline, const DiagnoseOptions& options) {
  options.validate();
  PartsDone told(options.watch, "diagnose", logs.size());
  std::vector<std::optional<Verdict>> judged(logs.size());
  side_by_side(static_cast<int>(logs.size()), options.threads, [&](int piece, int threads) {
    if (options.watch.stopped()) return;
    const auto at = static_cast<std::size_t>(piece);
    DiagnoseOptions of_log = options;
    of_log.threads = threads;
    of_log.watch = told.of(at);
    Verdict verdict = diagnose(logs[at], tuned, rig, baseline, of_log);
    told.tell(at, 1, verdict.simulations);
    if (!verdict.interrupted) judged[at] = std::move(verdict);
  });
  std::vector<Verdict> out;
  for (std::optional<Verdict>& v : judged)
    if (v) out.push_back(std::move(*v));
  return out;
}

}  // namespace servodx
