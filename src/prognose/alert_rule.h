// The rule of the alert: what a check's trend has reached, as evidence in, state out. No fit, no history.
//
//   the threshold lies beyond failure              blind: one check says nothing, only a trend can
//   a confirmed trend, or a last check beyond the threshold   watch
//   a confirmed trend towards failure, beyond the warning     warning, and an alert
//   that trend beyond the failure level                       failed
//   else                                                      healthy
#pragma once
#include <cstddef>

#include "prognose/level.h"
#include "prognose/trend_state.h"

namespace servodx {

struct TrendEvidence {
  bool confirmed = false;  // growth over none, see `is_confirmed`
  bool away = false;       // grows away from failure
  Level threshold, warning, failure;
  double last = 0;  // the last check, corrected
  double now = 0;   // the fitted curve there
};

struct AlertDecision {
  TrendState state = TrendState::unknown;
  bool blind = false;      // whatever the state
  bool predicted = false;  // a life is told: a confirmed trend towards failure
  bool alert = false;
};

AlertDecision decide(const TrendEvidence& evidence);

// A trend of one of so many checks, at a rate of false alarms of the valve: a Bayes factor above 1/rate comes by chance
// at that rate at most, however often one looks (Ville 1939).
bool is_confirmed(double log_bayes_factor, std::size_t checks, double false_alarm);

}  // namespace servodx
