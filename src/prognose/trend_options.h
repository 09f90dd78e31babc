// What a user asks of a trend.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "prognose/check_name.h"
#include "prognose/seeded.h"

namespace servodx {

using OneOrTwoLevels = std::pair<std::optional<double>, std::optional<double>>;  // lower, upper

struct TrendSettings {
  double false_alarm = 0.01;  // of a healthy valve
  int healthy = 12;           // first checks after a start or a reset that are taken as healthy
  std::map<CheckName, OneOrTwoLevels> failure;
  // Times its healthy value; of a parameter that multiplies its tuned one; where `failure` has none.
  std::map<CheckName, double> failure_ratio;
  // Of the spool's friction: [A] of coil current that it takes, see `friction_current`.
  std::map<CheckName, double> failure_current;
  // Of a parameter: one standard deviation of that level, in the unit it is stated in; else by the fault's own
  // `spread`.
  std::map<CheckName, double> failure_spread;
  // Of valves of the type: parameters are read as these were.
  std::vector<SeededReading> seeded;
  double coverage = 0.9;  // of the interval of the life left
  std::uint64_t seed = 1;
  int threads = 0;                  // 0: all; the result does not depend on it
  std::function<bool()> stop = {};  // true: no check is told, and a note says so
};

}  // namespace servodx
