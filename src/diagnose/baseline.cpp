#include "diagnose/baseline.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/healthy_law.h"
#include "evidence/conditions.h"
#include "evidence/rank_promise.h"
#include "faults/gross_finding.h"

namespace servodx {

namespace k = diagnose_constants;

namespace {

double score_by(const FaultGains& gains, const FaultGains& usual) {
  double score = 0;
  for (const auto& [fault, gain] : gains) {
    const auto known = usual.find(fault);
    const double of_health = known == usual.end() ? 0.0 : known->second;
    score = std::max(score, std::sqrt(std::max(0.0, gain) / (1.0 + of_health)));
  }
  return score;
}

FaultGains gains_of(const Assessment& a) {
  FaultGains gains;
  for (const HypothesisResult& h : a.hypotheses)
    if (h.fault) gains[h.fault] = h.gain;
  return gains;
}

}  // namespace

double score_of(const Assessment& a, const FaultGains& usual) {
  const double score = score_by(gains_of(a), usual);
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

namespace {

// But for its score, which is a statement beside others'.
DetectionBaseline::Score unscored(const Assessment& a) {
  DetectionBaseline::Score s{.log = a.log,
                             .sha256 = a.sha256,
                             .adequacy = a.hypotheses.front().adequacy,
                             .test = a.test,
                             .figures = a.figures,
                             .point = a.points.empty() ? OperatingPoint{} : a.points.front(),
                             .content = a.content};
  if (!a.explanations.empty()) s.healthy = a.explanations.front();
  s.gains = gains_of(a);
  return s;
}

std::vector<TestConditions> tests_of(const std::vector<DetectionBaseline::Score>& scores) {
  std::vector<TestConditions> out;
  for (const DetectionBaseline::Score& s : scores) out.push_back(*s.test);
  return out;
}

// Repeats of one programme as one log: what they show on average. At least one.
DetectionBaseline::Score as_one(const std::vector<DetectionBaseline::Score>& repeats) {
  DetectionBaseline::Score one = {.log = repeats.front().log, .sha256 = "", .test = repeats.front().test};
  DetectionBaseline alone;
  alone.scores = repeats;
  one.gains = usual_gains(alone);
  const auto n = static_cast<double>(repeats.size());
  double square = 0;
  for (const DetectionBaseline::Score& s : repeats) square += s.score * s.score / n, one.adequacy += s.adequacy / n;
  one.score = std::sqrt(square);
  return one;
}

std::vector<DetectionBaseline::Score> one_a_programme(const std::vector<DetectionBaseline::Score>& scores) {
  const std::vector<std::size_t> of = programmes_of(tests_of(scores));
  std::vector<std::vector<DetectionBaseline::Score>> programmes;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (of[i] == programmes.size()) programmes.emplace_back();
    programmes[of[i]].push_back(scores[i]);
  }
  std::vector<DetectionBaseline::Score> out;
  for (const auto& repeats : programmes) out.push_back(as_one(repeats));
  return out;
}

// The baseline's own repeats of a test that the model follows, each scored by the rest of them.
std::vector<DetectionBaseline::Score> repeats_of(const TestConditions& test, const DetectionBaseline& b) {
  DetectionBaseline repeats;
  for (const DetectionBaseline::Score& s : b.scores)
    if (s.test && is_repeat(*s.test, test) && is_followed(s.adequacy)) repeats.scores.push_back(s);
  for (std::size_t i = 0; i < repeats.scores.size(); ++i) {
    DetectionBaseline::Score& s = repeats.scores[i];
    if (s.score < k::gross_score) s.score = score_by(s.gains, usual_gains(repeats, static_cast<int>(i)));
  }
  return repeats.scores;
}

double largest_adequacy(const std::vector<DetectionBaseline::Score>& scores) {
  double most = 0;
  for (const DetectionBaseline::Score& s : scores) most = std::max(most, s.adequacy);
  return most;
}

}  // namespace

bool knows_test(const DetectionBaseline& b, const TestConditions& test) {
  const auto any = [&](const auto& is) { return std::any_of(b.scores.begin(), b.scores.end(), is); };
  if (any([](const DetectionBaseline::Score& s) { return !s.test; })) return true;  // it does not say its tests
  if (any([&](const DetectionBaseline::Score& s) { return is_repeat(*s.test, test); })) return true;
  return !nearest_of_unlike(test, b) && show_scatter_of_tests(tests_of(b.scores));
}

DetectionBaseline baseline_for(const TestConditions& test, const DetectionBaseline& b, int left_out) {
  if (auto repeats = repeats_of(test, b); repeats.size() >= k::fewest_repeats && repeats.size() < b.scores.size()) {
    DetectionBaseline out = b;
    out.scores = std::move(repeats);
    out.others.clear();
    out.of_repeats = true;
    return out;
  }
  if (b.others.empty() || knows_test(b, test)) return b;
  std::vector<DetectionBaseline::Score> all = one_a_programme(b.scores), like;
  for (std::size_t i = 0; i < b.others.size(); ++i) {
    if (static_cast<int>(i) == left_out) continue;
    all.push_back(b.others[i]);
    if (b.others[i].test && distance(test, *b.others[i].test) <= 1) like.push_back(b.others[i]);
  }
  DetectionBaseline out = b;
  out.scores = like.empty() ? std::move(all) : std::move(like);
  out.others.clear();
  out.of_other_tests = true;
  out.adequacy_limit = std::max(largest_adequacy(b.scores), largest_adequacy(out.scores));
  return out;
}

DetectionBaseline baseline_of(const std::vector<Assessment>& healthy, double false_alarm,
                              const std::vector<Assessment>& others) {
  DetectionBaseline b;
  b.asked = false_alarm;
  for (const Assessment& a : healthy) b.scores.push_back(unscored(a));
  if (b.scores.empty()) return b;
  b.adequacy_limit = largest_adequacy(b.scores);
  for (std::size_t i = 0; i < healthy.size(); ++i)
    b.scores[i].score = score_of(healthy[i], usual_gains(b, static_cast<int>(i)));
  for (const Assessment& a : others) b.others.push_back(unscored(a));
  for (std::size_t i = 0; i < others.size(); ++i)
    b.others[i].score = score_of(others[i], usual_gains(baseline_for(others[i].test, b, static_cast<int>(i))));
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
