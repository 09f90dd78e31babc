#include "diagnose/judge.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

#include "diagnose/conditions.h"
#include "diagnose/constants.h"
#include "diagnose/healthy_law.h"
#include "evidence/posterior.h"
#include "evidence/rank_promise.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

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

std::optional<Diagnosis::Unlike> unlike_all(const TestConditions& test, const DetectionBaseline& baseline) {
  const DetectionBaseline::Score* nearest = nearest_of_unlike(test, baseline);
  if (!nearest) return {};
  return Diagnosis::Unlike{nearest->log, *nearest->test};
}

double p_value_of(double error, const DetectionBaseline& baseline, const HealthyLaw& law) {
  std::vector<double> healthy;
  for (const std::size_t i : law.positions()) healthy.push_back(baseline.scores[i].score);
  return rank_p_value(error, healthy);
}

// Health against all faults together: even where the verdict turns, so that no probability contradicts it. The faults
// share the rest as their fits do.
void weigh_health(std::vector<double>& probabilities, double chance, double rate) {
  const double odds = factor_for_nothing(chance) / factor_for_nothing(rate), healthy = odds / (1 + odds);
  const double faults = std::accumulate(probabilities.begin() + 1, probabilities.end(), 0.0);
  if (!(faults > 0)) return;
  probabilities.front() = healthy;
  for (std::size_t i = 1; i < probabilities.size(); ++i) probabilities[i] *= (1 - healthy) / faults;
}

Suspicion suspicion_of(const HypothesisResult& h, double gain, const HealthyLaw& law) {
  return {h.fault,
          h.severity,
          h.severity_lower,
          h.severity_upper,
          std::min(1.0, law.chance_of_gain(gain) / k::share_of_gain),
          law.logs(),
          law.logs_needed(gain)};
}

}  // namespace

Evidence evidence_of(const Assessment& a, const DetectionBaseline& baseline) {
  const SuspectLog suspect = suspect_of(a);
  const HealthyLaw law(baseline, &suspect);
  Evidence e;
  e.gain = score_of(a, usual_gains(baseline));
  e.error = law.error_of(e.gain, a.hypotheses.front().adequacy);
  e.threshold = law.limit();
  e.usual_adequacy = baseline.adequacy_limit;
  e.gross = a.gross;
  for (const HypothesisResult& h : a.hypotheses)
    e.hypotheses.push_back({h.fault, h.probability, h.adequacy, h.at_worst, h.gain});
  return e;
}

Diagnosis judge(Assessment a, const DetectionBaseline& baseline) {
  const Evidence evidence = evidence_of(a, baseline);
  Decision decision = decide(evidence);
  const HypothesisResult& told = a.hypotheses[decision.hypothesis];
  Diagnosis d;
  d.log = a.log;
  d.verdict = decision.verdict;
  d.error = evidence.error, d.threshold = evidence.threshold;
  const SuspectLog suspect = suspect_of(a);
  const HealthyLaw law(baseline, &suspect);
  d.p_value = p_value_of(evidence.error, baseline, law);
  d.baseline_logs = law.logs();
  if (decision.verdict != VerdictKind::unknown && decision.severity != SeveritySource::seen_outright)
    weigh_health(decision.probabilities, law.chance_of_gain(evidence.gain), law.rate());
  if (decision.suspected && law.chance_of_gain(evidence.gain) <= k::worth_saying)
    d.suspicion = suspicion_of(a.hypotheses[*decision.suspected], evidence.gain, law);
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
