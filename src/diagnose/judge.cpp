#include "diagnose/judge.h"

#include <algorithm>

#include "evidence/rank_promise.h"

namespace servodx {
namespace {

void size_by_fit(Diagnosis& d, const HypothesisResult& h) {
  d.severity = {h.severity, h.severity_lower, h.severity_upper};
}

// The worst of the fault, up to the mildest that the finding leaves open.
void size_outright(Diagnosis& d, const HypothesisResult& h) {
  const double worst = h.fault->worst, mildest = h.fault->seen_outright->mildest;
  d.severity.value = worst;
  d.severity.lower = worst < mildest ? worst : std::min(mildest, h.severity_lower);
  d.severity.upper = worst < mildest ? std::max(mildest, h.severity_upper) : worst;
}

std::optional<Diagnosis::Unlike> unlike_all(const TestConditions& test, const Baseline& baseline) {
  const Baseline::Score* nearest = nearest_of_unlike(test, baseline);
  if (!nearest) return {};
  return Diagnosis::Unlike{nearest->log, *nearest->test};
}

double p_value_of(double error, const Baseline& baseline) {
  std::vector<double> healthy;
  for (const Baseline::Score& s : baseline.scores) healthy.push_back(s.score);
  return rank_p_value(error, healthy);
}

}  // namespace

Evidence evidence_of(const Assessment& a, const Baseline& baseline) {
  Evidence e;
  e.error = score_of(a, usual_gains(baseline));
  e.threshold = baseline.threshold;
  e.usual_adequacy = baseline.adequacy_limit;
  e.gross = a.gross;
  for (const HypothesisResult& h : a.hypotheses) e.hypotheses.push_back({h.fault, h.probability, h.adequacy});
  return e;
}

Diagnosis judge(Assessment a, const Baseline& baseline) {
  const Evidence evidence = evidence_of(a, baseline);
  const Decision decision = decide(evidence);
  const HypothesisResult& told = a.hypotheses[decision.hypothesis];
  Diagnosis d;
  d.log = a.log;
  d.verdict = decision.verdict;
  d.error = evidence.error, d.threshold = evidence.threshold;
  d.p_value = p_value_of(evidence.error, baseline);
  d.baseline_logs = static_cast<int>(baseline.scores.size());
  d.unlike = unlike_all(a.test, baseline);
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i)
    d.probabilities.push_back({a.hypotheses[i].fault, decision.probabilities[i]});
  for (const std::size_t i : decision.ambiguous) d.ambiguous_with.push_back(a.hypotheses[i].fault);
  if (decision.verdict == VerdictKind::fault) d.fault = told.fault;
  if (decision.severity == SeveritySource::fit) size_by_fit(d, told);
  if (decision.severity == SeveritySource::seen_outright) size_outright(d, told);
  d.onset = a.onset;
  d.nearest = told.fault;
  d.null = told.null;
  d.moved = told.moved;
  d.assessment = std::move(a);
  return d;
}

}  // namespace servodx
