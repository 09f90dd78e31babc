// The levels that one check of a healthy valve passes seldom: from what its first checks scatter by.
//
// threshold  once in 1 / false_alarm checks
// warning    once in 1 / false_alarm valves, over 100 checks of all its names; a quarter of the way to failure at the
//            latest, where the trend test alone stands against false alarms
// Limits: a normal scatter, the same all life long.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "prognose/growth.h"
#include "prognose/level.h"
#include "prognose/reading_scale.h"

namespace servodx {

struct HealthyChecks {
  double centre = 0;  // of y: where the figure began
  double spread = 0;  // of one further check about it
};
// `begun`: the growth that the first checks alone show. `corrected`: these checks at reference conditions. What grows
// from the first check on began below its first checks: at the whole growth's base, where the trend is confirmed.
HealthyChecks healthy_checks(const Growth& whole, bool confirmed, const Growth& begun,
                             std::span<const GrowthPoint> first, std::span<const double> corrected);

struct HealthyLevels {
  Level threshold, warning;  // [unit of the check]
};
HealthyLevels healthy_levels(const HealthyChecks& checks, const ReadingScale& scale, int direction, std::size_t names,
                             double false_alarm);
// A warning comes at a part of the way to failure at the latest: the rest is left to act in.
Level warned_in_time(const Level& warning, const Level& failure, const HealthyChecks& checks,
                     const ReadingScale& scale);

}  // namespace servodx
