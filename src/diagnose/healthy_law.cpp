#include "diagnose/healthy_law.h"

#include <algorithm>
#include <cmath>

#include "base/student.h"
#include "diagnose/constants.h"
#include "evidence/constants.h"
#include "evidence/rank_promise.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

std::vector<std::size_t> all_of(const DetectionBaseline& b) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < b.scores.size(); ++i) out.push_back(i);
  return out;
}

std::vector<std::size_t> logs_for(const DetectionBaseline& b, const SuspectLog* suspect) {
  const bool lost = suspect && !is_followed(suspect->adequacy);
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < b.scores.size(); ++i) {
    const DetectionBaseline::Score& s = b.scores[i];
    const bool alike = lost && s.test && distance(suspect->test, *s.test) <= 1;
    if (alike || is_followed(s.adequacy)) out.push_back(i);
  }
  return out.size() < k::fewest_logs ? all_of(b) : out;
}

std::vector<double> squares_of(const DetectionBaseline& b, const std::vector<std::size_t>& logs) {
  std::vector<double> out;
  for (const std::size_t i : logs) out.push_back(b.scores[i].score * b.scores[i].score);
  return out;
}

}  // namespace

bool is_followed(double adequacy) { return adequacy <= evidence_constants::followed_adequacy; }

SuspectLog suspect_of(const Assessment& a) {
  SuspectLog out{a.test, a.hypotheses.front().adequacy, std::max<std::size_t>(1, a.logs.size())};
  for (const HypothesisResult& h : a.hypotheses) out.adequacy = std::min(out.adequacy, h.adequacy);
  return out;
}

HealthyLaw::HealthyLaw(const DetectionBaseline& b, const SuspectLog* suspect)
    : positions_(logs_for(b, suspect)),
      gains_(squares_of(b, positions_), {k::usual_gain, k::usual_logs}),
      asked_(b.asked) {
  if (!b.of_other_tests) promising_ = std::max(static_cast<int>(positions_.size()), b.logs);
  std::vector<double> ranked;
  for (const std::size_t i : positions_) ranked.push_back(b.scores[i].score);
  for (const DetectionBaseline::Score& s : b.scores) adequacies_.push_back(s.adequacy);
  const double by_law = std::sqrt(gains_.excess_at(rate()));
  limit_ = std::max(by_law, rank_promise(ranked, asked_).threshold);
  // A baseline of one or two logs of such tests: as wrong as on the tuning logs is 1 by definition.
  while (adequacies_.size() < k::fewest_logs) adequacies_.push_back(1.0);
  const Deviate one = deviate_of(1, adequacies_, {k::adequacy_spread, k::usual_logs});
  constexpr double sides = 2;  // the quantile's tail has two, an adequacy's one
  const double worst_of = suspect ? static_cast<double>(suspect->logs) : 1.0;
  unlike_limit_ = student_quantile(sides * rate_of(k::share_of_adequacy) / worst_of, one.degrees);
}

// Where nothing is promised, the law alone speaks: it is asked for the rate itself, not for what so many logs could
// promise.
double HealthyLaw::rate_of(double share) const {
  return promising_ ? rate_of_question(asked_, *promising_, share) : share * asked_;
}

double HealthyLaw::error_of(double gain, double adequacy) const {
  const Deviate unlike = deviate_of(adequacy, adequacies_, {k::adequacy_spread, k::usual_logs});
  return std::max(gain, limit_ * unlike.t / unlike_limit_);
}

int HealthyLaw::logs_needed(double gain) const { return gains_.logs_needed(gain * gain, asked_, k::share_of_gain); }

}  // namespace servodx
