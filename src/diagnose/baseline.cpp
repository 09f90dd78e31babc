#include "diagnose/baseline.h"

#include <algorithm>
#include <cmath>

#include "diagnose/constants.h"
#include "diagnose/healthy_law.h"
#include "evidence/conditions.h"
#include "evidence/rank_promise.h"
#include "faults/gross_finding.h"

namespace servodx {

namespace k = diagnose_constants;

double score_of(const Assessment& a, const FaultGains& usual) {
  double score = 0;
  for (const HypothesisResult& h : a.hypotheses) {
    const auto known = h.fault ? usual.find(h.fault) : usual.end();
    const double of_health = known == usual.end() ? 0.0 : known->second;
    score = std::max(score, std::sqrt(std::max(0.0, h.gain) / (1.0 + of_health)));
  }
  return a.gross == GrossFinding::none ? score : std::max(score, k::gross_score);
}

FaultGains usual_gains(const DetectionBaseline& baseline, int left_out) {
  FaultGains usual;
  for (std::size_t i = 0; i < baseline.scores.size(); ++i)
    if (static_cast<int>(i) != left_out)
      for (const auto& [fault, gain] : baseline.scores[i].gains) usual[fault] += std::max(0.0, gain);
  const auto logs = static_cast<double>(baseline.scores.size()) - (left_out >= 0 ? 1.0 : 0.0);
  for (auto& [fault, gain] : usual) gain /= logs;
  return usual;
}

DetectionBaseline baseline_of(const std::vector<Assessment>& healthy, double false_alarm) {
  DetectionBaseline b;
  b.asked = false_alarm;
  for (const Assessment& a : healthy) {
    const double adequacy = a.hypotheses.front().adequacy;
    b.scores.push_back({a.log, a.sha256, 0.0, adequacy, {}, a.test, a.figures, a.point, {}});
    if (!a.explanations.empty()) b.scores.back().healthy = a.explanations.front();
    for (const HypothesisResult& h : a.hypotheses)
      if (h.fault) b.scores.back().gains[h.fault] = h.gain;
    b.adequacy_limit = std::max(b.adequacy_limit, adequacy);
  }
  if (b.scores.empty()) return b;
  for (std::size_t i = 0; i < healthy.size(); ++i)
    b.scores[i].score = score_of(healthy[i], usual_gains(b, static_cast<int>(i)));
  const HealthyLaw law(b, nullptr);
  std::vector<double> scores;
  for (const std::size_t i : law.positions()) scores.push_back(b.scores[i].score);
  const RankPromise promise = rank_promise(std::move(scores), false_alarm);
  b.threshold = law.limit();
  b.logs = law.logs();
  b.promised = promise.promised, b.promised_95 = promise.promised_95;
  b.logs_needed = promise.logs_needed;
  return b;
}

bool keeps_rate(const DetectionBaseline& b) { return promise_kept(b.promised, b.asked); }

const DetectionBaseline::Score* nearest_of_unlike(const TestConditions& test, const DetectionBaseline& baseline) {
  const DetectionBaseline::Score* nearest = nullptr;
  double least = HUGE_VAL;
  for (const DetectionBaseline::Score& s : baseline.scores) {
    if (!s.test) return nullptr;
    if (const double d = distance(test, *s.test); !nearest || d < least) least = d, nearest = &s;
  }
  return least <= 1 ? nullptr : nearest;
}

}  // namespace servodx
