// `trend`: from a valve's history to its state, the level each check has reached, and the life left.
//
// Per check, in its corrected value (temperature by what the valve's healthy checks show, with the model's expectation
// as one of the regressors):
//   threshold  what one healthy check passes once in 1 / false_alarm
//   warning    what the checks of a healthy valve pass once in 1 / false_alarm valves, over 100 checks of all its
//   names;
//              a quarter of the way to failure at the latest
//   failure    the user's, or the fault's own (Borello's end of range); the paper's checks have none unless given
// A trend is confirmed when the Bayes factor of growth passes names / false_alarm. An alert is a confirmed trend whose
// fitted curve has passed the warning level. No trend is an answer. Two-sided for r and E.
//
// Fusion: the cause is the tracked parameter with the most certain trend of those that have surely come at least half
// as far on their way to failure as the furthest (the 5 % quantile of that part: what is read widely comes near by
// chance, and what wears draws the readings of others with it, less certainly), and the remaining life is its. Where no
// parameter has one, the lives of the paper's checks that have a failure level are pooled, each by its sharpness: what
// they read depends on more than the cause, so beside a cause they only blur it. Maintenance events restart what they
// renew (history.h); so does another tuned table.
#pragma once
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "prognose/check_name.h"
#include "prognose/growth.h"
#include "prognose/history.h"
#include "prognose/seeded.h"
#include "prognose/trend_state.h"

namespace servodx {

struct TrendOptions {
  double false_alarm = 0.01;  // of a healthy valve
  int healthy = 12;           // first checks after a start or a reset that are taken as healthy
  std::map<CheckName, std::pair<std::optional<double>, std::optional<double>>> failure;  // name -> lower, upper
  // name -> times its healthy value, of a parameter that multiplies its tuned one, where `failure` has none
  std::map<CheckName, double> failure_ratio;
  // name of the spool's friction -> [A] of coil current that it takes, see `friction_current`
  std::map<CheckName, double> failure_current;
  // name of a parameter -> one standard deviation of that level, in the unit it is stated in; else by the fault's own
  // `spread`
  std::map<CheckName, double> failure_spread;
  // of valves of the type: parameters are read as these were
  std::vector<SeededReading> seeded;
  double coverage = 0.9;  // of the interval of the life left
  std::uint64_t seed = 1;
  int threads = 0;  // 0: all; the result does not depend on it
};

// [A/N] coil current that holds a force on the spool: the pilot pressure that balances it presses on the flapper,
// nozzle over spool area, against the motor. From the tuned rows. A log holds currents and motion; what a current is in
// newtons at the spool rests on the motor's gain and the nozzles' bore, and what a table has wrong of them all its
// friction has.
double friction_current(const std::vector<double>& tuned);

struct Level {
  std::optional<double> lower, upper;  // [unit of the check]
};

struct Remaining {
  double median = 0, lower = 0, upper = 0;  // [h]; infinite where never
};
Remaining remaining_of(const Life& life, double coverage);

struct TangentRule {
  double alert_at = 0;         // [h]
  double time_to_failure = 0;  // [h] from the alert
};

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
  std::vector<std::string> notes;
};

ValveTrend trend(const ValveHistory& history, const TrendOptions& options);

// The paper's rule (sec. 9): a quadratic by least squares through what lies beyond the threshold; alert where it passes
// the warning level; time to failure = (failure - warning) / slope of the tangent there. Rising figures; mirror others.
std::optional<TangentRule> tangent_rule(const std::vector<double>& time, const std::vector<double>& value,
                                        double threshold, double warning, double failure);

}  // namespace servodx
