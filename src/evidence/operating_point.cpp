#include "servodx/operating_point.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "base/median.h"
#include "base/present.h"
#include "evidence/constants.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/drive_of.h"
#include "signals/signal.h"

namespace servodx {
namespace {

using namespace evidence_constants;

std::optional<double> median_of(const Log& log, Signal s) {
  if (!log.has(s)) return {};
  const std::vector<double> x = present(log[s]);
  return x.empty() ? std::nullopt : std::optional(median(x));
}

std::optional<double> largest_of(const Log& log, Signal s) {
  if (!log.has(s)) return {};
  double most = -1;
  for (const double v : present(log[s])) most = std::max(most, std::abs(v));
  return most < 0 ? std::nullopt : std::optional(most);
}

double margin_of(Condition c, double around) {
  switch (c) {
    case Condition::supply:
      return like_supply * around;
    case Condition::return_pressure:
      return std::max(like_return, like_return_part * around);
    case Condition::oil:
      return like_temperature;
    case Condition::load:
    case Condition::drive:
      return like_size * around;
  }
  return 0;
}

// A smaller load or drive is inside what a larger one showed.
bool has_lower_end(Condition c) { return c != Condition::load && c != Condition::drive; }

bool is_beyond(const ConditionRow& row) {
  const auto known = [&](const auto& healthy, const auto& tuned) {
    return healthy ? healthy : tuned ? tuned : row.sheet;
  };
  const std::optional<double> least = known(row.lowest, row.tuned_lowest), most = known(row.highest, row.tuned_highest);
  if (!row.value || !least) return false;
  return *row.value > *most + margin_of(row.of, *most) ||
         (has_lower_end(row.of) && *row.value < *least - margin_of(row.of, *least));
}

void widen(std::optional<double>& lowest, std::optional<double>& highest, const std::vector<OperatingPoint>& points,
           Condition of) {
  for (const OperatingPoint& p : points)
    if (const auto& x = p[static_cast<std::size_t>(of)]) {
      lowest = std::min(lowest.value_or(*x), *x);
      highest = std::max(highest.value_or(*x), *x);
    }
}

}  // namespace

OperatingPoint operating_point_of(const Log& log) {
  return {median_of(log, Signal::supply_pressure), median_of(log, Signal::return_pressure),
          median_of(log, Signal::oil_temperature), largest_of(log, Signal::load_force), largest_of(log, drive_of(log))};
}

OperatingPoint sheet_point(const RigFile& rig) {
  return {rig.fact("supply.pressure"),
          rig.fact("supply.return_pressure"),
          rig.oil_temperature,
          {},
          rig.fact("valve.rated_current")};
}

std::vector<ConditionRow> conditions_beside(const std::vector<OperatingPoint>& logs, const OperatingPoint& sheet,
                                            const std::vector<OperatingPoint>& healthy) {
  std::vector<ConditionRow> out;
  for (int i = 0; i < n_conditions; ++i) {
    const auto at = static_cast<std::size_t>(i);
    ConditionRow row{static_cast<Condition>(i), {}, sheet[at], {}, {}, false};
    widen(row.lowest, row.highest, healthy, row.of);
    for (const OperatingPoint& log : logs) {
      if (row.beyond || !log[at]) continue;
      ConditionRow of_log = row;
      of_log.value = log[at];
      of_log.beyond = is_beyond(of_log);
      if (!row.value || of_log.beyond) row = of_log;
    }
    if (row.value || row.sheet) out.push_back(row);
  }
  return out;
}

void set_beside_tuning(std::vector<ConditionRow>& rows, const std::vector<OperatingPoint>& tuning) {
  for (ConditionRow& row : rows) {
    widen(row.tuned_lowest, row.tuned_highest, tuning, row.of);
    row.beyond = is_beyond(row);
  }
}

}  // namespace servodx
