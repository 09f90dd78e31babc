// The front door of `explain`.
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/error.h"
#include "door/require_samples.h"
#include "evidence/heldout_gain.h"
#include "explain/explain.h"
#include "explain/healthy.h"
#include "explain/outcome.h"
#include "report/explain/explain_report.h"
#include "report/explain/explain_words.h"
#include "servodx/baseline.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/tune.h"
#include "store/baseline_parts.h"

namespace servodx {
namespace {

Explanation::Kind kind_of(ExplainVerdict verdict) {
  switch (verdict) {
    case ExplainVerdict::sufficient:
      return Explanation::Kind::sufficient;
    case ExplainVerdict::extended:
      return Explanation::Kind::extended;
    case ExplainVerdict::unexplained:
      return Explanation::Kind::unexplained;
  }
  return Explanation::Kind::unexplained;
}

Explanation::Parameter::Told told_of(SizeTold told) {
  switch (told) {
    case SizeTold::interval:
      return Explanation::Parameter::Told::interval;
    case SizeTold::at_bound:
      return Explanation::Parameter::Told::at_bound;
    case SizeTold::not_told:
      return Explanation::Parameter::Told::not_told;
  }
  return Explanation::Parameter::Told::not_told;
}

Explanation::Cause cause_of(const ExplainedCause& c) {
  Explanation::Cause out{c.effect, c.where, {}, {}, c.delta_bic, c.confusable_with};
  for (const ExplainedParameter& p : c.parameters)
    out.parameters[p.name] = {p.value, p.std_error, p.unit, p.lower, p.upper, told_of(p.told)};
  out.heldout_gain = {c.heldout_gain.value, c.heldout_gain.lower, c.heldout_gain.upper};
  return out;
}

Explanation explanation_of(ExplainResult r) {
  Explanation out;
  out.kind = kind_of(r.verdict);
  out.where = r.where, out.depends_on = r.depends_on;
  for (const ExplainedChannel& c : r.channels)
    out.channels.push_back(
        {c.signal, c.unit, c.rms_before, c.rms_after, c.noise_rms, c.heldout_before, c.heldout_after});
  for (const ExplainedCause& c : r.causes) out.causes.push_back(cause_of(c));
  for (const ExplainedCause& c : r.standing) out.standing.push_back(cause_of(c));
  for (const ExplainedCandidate& c : r.candidates)
    out.candidates.push_back({c.effect, c.where, report::words_of(c.fate), is_taken(c.fate)});
  if (r.probabilities) {
    for (const ExplainedProbability& p : r.probabilities->causes) out.probabilities[p.cause] = p.value;
    out.probabilities["unlisted"] = r.probabilities->unlisted;
    out.probabilities["nothing"] = r.probabilities->nothing;
  }
  out.table = r.table;
  out.notes = r.notes;
  out.simulations = r.simulations, out.failed_simulations = r.failed_simulations;
  out.interrupted = r.interrupted;
  out.whole = std::make_shared<ExplainResult>(std::move(r));
  return out;
}

}  // namespace

std::string name_of(Explanation::Kind kind) {
  switch (kind) {
    case Explanation::Kind::sufficient:
      return report::word_of(ExplainVerdict::sufficient);
    case Explanation::Kind::extended:
      return report::word_of(ExplainVerdict::extended);
    case Explanation::Kind::unexplained:
      return report::word_of(ExplainVerdict::unexplained);
  }
  return "";
}

std::string name_of(Explanation::Parameter::Told told) {
  switch (told) {
    case Explanation::Parameter::Told::interval:
      return report::word_of(SizeTold::interval);
    case Explanation::Parameter::Told::at_bound:
      return report::word_of(SizeTold::at_bound);
    case Explanation::Parameter::Told::not_told:
      return report::word_of(SizeTold::not_told);
  }
  return "";
}

std::string json_of(const Explanation& explanation) {
  return explanation.whole ? report::explain_json(*explanation.whole).dump(2) : "null";
}

Explanation explain(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig, const ExplainOptions& options) {
  options.validate();
  door::require_samples(logs, rig);
  return explanation_of(explain_logs(logs, tuned.table, rig, nullptr, options));
}

Explanation explain(const std::vector<Log>& logs, const Tuned& tuned, const Rig& rig, const Baseline& baseline,
                    const ExplainOptions& options) {
  options.validate();
  door::require_samples(logs, rig);
  const std::optional<Note> of_baseline = require_same_table(baseline, tuned);
  const HealthyReference& causes = causes_of(baseline);
  ExplainOptions at_its_rate = options;
  at_its_rate.level = baseline.asked;
  ExplainResult result = explain_logs(logs, tuned.table, rig, &causes, at_its_rate);
  if (of_baseline) result.notes.push_back(*of_baseline);
  for (Note& note : notes_beside(baseline, rig, logs)) result.notes.push_back(std::move(note));
  return explanation_of(std::move(result));
}

}  // namespace servodx
