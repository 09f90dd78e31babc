// `trend`: from a valve's history to its state, the level each check has reached, and the life left.
//
// Per check, in its corrected value (temperature by what the valve's healthy checks show, with the model's expectation
// as one of the regressors): threshold and warning by what health scatters (healthy_levels.h), failure as the user or
// the fault says (failure_level.h), a trend by the growth model (growth.h), and what follows of these by alert_rule.h.
// No trend is an answer. Two-sided for r and E.
//
// The cause, and whose life counts: cause_rule.h. Maintenance events restart what they renew (valve_history.h); so does
// another tuned table.
#pragma once
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "prognose/check_name.h"
#include "prognose/level.h"
#include "prognose/life.h"
#include "prognose/tangent_rule.h"
#include "prognose/trend_options.h"
#include "prognose/trend_state.h"
#include "prognose/valve_history.h"
#include "servodx/note.h"

namespace servodx {

struct CheckTrend {
  CheckName name;
  std::string unit, cause;
  TrendState state = TrendState::unknown;
  bool blind = false;  // one check cannot tell failure from health at this false-alarm rate: only a trend can
  Level threshold, warning, failure;
  double healthy = 0;                 // where it began
  double now = NAN, now_error = NAN;  // corrected, fitted; NaN where the checks are too few
  double slope = 0;                   // [unit / h]
  double surely = 0;                  // part of the way to failure that it has come in 95 of 100 cases
  double log_bayes_factor = 0;
  bool trend = false;
  std::optional<double> alert_at;      // [h]
  std::optional<Remaining> remaining;  // to failure
  std::optional<TangentRule> tangent;
  double to_warning = 0;  // [h] median; infinite without a trend, 0 when it is passed
  Life life;              // behind `remaining`
  struct Point {
    double at, value, temperature;
    bool healthy;
  };
  std::vector<Point> points;  // corrected
};

struct ValveTrend {
  std::string valve, serial;
  TrendState state = TrendState::unknown;
  double at = 0;  // [h] of the last check
  std::size_t checks = 0;
  std::optional<std::string> cause;  // label of a fault
  std::optional<double> alert_at;
  std::optional<Remaining> remaining;
  Life life;
  double to_warning = 0;
  std::vector<CheckTrend> trends;
  std::vector<Note> notes;
};

ValveTrend trend(const ValveHistory& history, const TrendSettings& options);

}  // namespace servodx
