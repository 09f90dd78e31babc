#include "prognose/alert_rule.h"

#include <cmath>

namespace servodx {
namespace {

// Where health alone scatters beyond failure.
bool hides_failure(const Level& threshold, const Level& failure) {
  return (threshold.upper && failure.upper && *threshold.upper >= *failure.upper) ||
         (threshold.lower && failure.lower && *threshold.lower <= *failure.lower);
}

}  // namespace

bool is_confirmed(double log_bayes_factor, std::size_t checks, double false_alarm) {
  return log_bayes_factor > std::log(static_cast<double>(checks) / false_alarm);
}

AlertDecision decide(const TrendEvidence& e) {
  AlertDecision out;
  out.blind = hides_failure(e.threshold, e.failure);
  out.predicted = e.confirmed && !e.away;
  out.alert = out.predicted && e.warning.passed_by(e.now);
  if (out.predicted && e.failure.passed_by(e.now))
    out.state = TrendState::failed;
  else if (out.alert)
    out.state = TrendState::warning;
  else if (e.confirmed || (!out.blind && e.threshold.passed_by(e.last)))
    out.state = TrendState::watch;
  else
    out.state = out.blind ? TrendState::blind : TrendState::healthy;
  return out;
}

}  // namespace servodx
