// The numbers behind the charts of results: a log beside its simulation, a valve's checks and its life left, a tune's
// costs.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/trend.h"
#include "servodx/tune.h"

namespace servodx {

struct LogChart {
  struct OfSignal {
    Signal signal = Signal::time;
    std::string unit;               // as in the log
    std::vector<double> measured;   // [SI] NaN where missing
    std::vector<double> simulated;  // [SI]; empty where the simulation left the finite numbers
    std::vector<double> residual;   // [SI] measured less simulated, filtered as a fit does
    std::vector<double> sigma;      // [SI] what the residual is expected to be: the sensor's noise, the model's error
  };
  std::string log;
  std::vector<double> time;     // [s]
  std::vector<double> command;  // [A] what drove the simulation
  std::vector<OfSignal> signals;
};
// The log replayed by a table, tuned or not. Throws InputError.
LogChart chart_of(const Log& log, const Table& table, const Rig& rig);

struct TrendChart {
  struct Range {
    std::optional<double> lower, upper;  // [unit of the check]
  };
  struct Point {
    double at = 0, value = 0;  // [h], [unit of the check] corrected
    double temperature = 0;    // [K]
    bool healthy = false;      // among those that health was learnt from
  };
  struct OfCheck {
    std::string name, unit, cause;
    std::vector<Point> points;
    Range threshold, warning, failure;
    double healthy = 0, now = 0, slope = 0;  // [unit], [unit], [unit / h]; NaN where the checks are too few
    bool grows = false;
    std::vector<double> life;  // [h] equally likely hours from the last check to failure, sorted; infinite where never
  };
  std::vector<OfCheck> checks;
  std::vector<double> life;  // of the valve
};
// Empty of a trend that trend() did not make.
TrendChart chart_of(const Trend& trend);

struct TuneChart {
  struct Point {
    std::string stage;  // costs compare within a stage
    long simulations = 0;
    double cost = 0;
  };
  std::vector<Point> convergence;
  std::vector<double> starts;  // costs at which the local searches ended
};
// Empty of a table that was read.
TuneChart chart_of(const Tuned& tuned);

}  // namespace servodx
