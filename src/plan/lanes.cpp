#include "plan/lanes.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "diagnose/hypotheses.h"
#include "diagnose/severity.h"
#include "faults/sizes.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "plan/constants.h"

namespace servodx {
namespace {

namespace k = plan_constants;

void move(const FreeValue& f, double u, ParameterVector& candidate) {
  if (f.apply)
    f.apply(candidate.data(), f.from_unit(u));
  else
    candidate[static_cast<std::size_t>(f.at)] = f.from_unit(u);
}

// Moved by one standard deviation, or as far as there is room.
Lane moved(const ParameterVector& base, const FreeValue& f) {
  const double u = f.to_unit(f.start);
  const double sd = std::isfinite(f.prior_sd) ? f.prior_sd : 1.0;
  const double step = std::min({sd, k::longest_step, std::max(u, 1 - u)});
  Lane lane{base, sd / step};
  move(f, u + step <= 1 ? u + step : u - step, lane.candidate);
  return lane;
}

int add(LaneSet& set, Lane lane) {
  set.lanes.push_back(std::move(lane));
  return static_cast<int>(set.lanes.size()) - 1;
}

// What a hypothesis leaves free, by name: of a fault its own severity first.
std::vector<FreeValue> free_of(const LogData& like, const ParameterVector& base, const Fault* fault, double severity,
                               double null_limit) {
  const std::vector<FaultStart> faults = fault ? std::vector<FaultStart>{{fault, severity}} : std::vector<FaultStart>{};
  return hypothesis_values({&like}, base, faults, null_limit);
}

SeverityLanes side_of(LaneSet& set, const FreeValue& range, const Fault& fault, int grid) {
  SeverityLanes out;
  const bool mild_first = std::abs(range.lower - fault.healthy) <= std::abs(range.upper - fault.healthy);
  for (int i = 0; i < grid; ++i) {
    const double part = k::grid_end * i / std::max(1, grid - 1);
    const double u = mild_first ? part : 1 - part;
    Lane lane{set.base, 1};
    move(range, u, lane.candidate);
    out.severity.push_back(range.from_unit(u));
    out.lanes.push_back(add(set, std::move(lane)));
  }
  return out;
}

void add_rival(LaneSet& set, const LogData& like, const Fault& fault, double null_limit, int grid,
               const std::vector<FreeValue>& health) {
  RivalLanes rival;
  rival.fault = &fault;
  const bool two_sided = std::any_of(fault.starts.begin(), fault.starts.end(), [](double s) { return s < 0; });
  const double start = sizes_of(fault, set.base.data()).starts.front();
  const std::vector<FreeValue> free = free_of(like, set.base, &fault, start, null_limit);
  rival.sides.push_back(side_of(set, free.front(), fault, grid));
  if (two_sided)
    rival.sides.push_back(side_of(set, free_of(like, set.base, &fault, -start, null_limit).front(), fault, grid));
  std::set<std::string> names;
  for (std::size_t j = 1; j < free.size(); ++j) names.insert(free[j].name);
  for (std::size_t j = 0; j < health.size(); ++j)
    if (names.contains(health[j].name)) rival.beside.push_back(set.health[j]);
  set.rivals.push_back(std::move(rival));
}

// The tuned table says how well each row is known already.
void add_rows(LaneSet& set, const Table& tuned, const std::vector<std::string>& wanted) {
  std::vector<FreeValue> shared = shared_values(tuned);
  for (FreeValue& f : shared) {
    const Row& row = tuned[tuned.find(f.name)];
    const double known = row.std_error.value_or(HUGE_VAL) / std::abs(f.slope(row.nominal));
    if (std::isfinite(known) && known > 0) f.prior_sd = std::min(f.prior_sd, known);
    const int lane = add(set, moved(set.base, f));
    set.beside_rows.push_back(lane);
    if (std::find(wanted.begin(), wanted.end(), f.name) != wanted.end())
      set.rows.push_back({f.name, row.unit, f.prior_sd * std::abs(f.slope(row.nominal)), lane});
  }
  set.beside_rows.insert(set.beside_rows.end(), set.of_log.begin(), set.of_log.end());
  for (const std::string& name : wanted)
    if (std::none_of(set.rows.begin(), set.rows.end(), [&](const RowLane& r) { return r.name == name; }))
      throw InputError({"--rows", 0, ""}, "'" + name + "' is not a row of the table that a fit may free",
                       "name rows with estimate = 1; 'servodx list params' shows them");
}

}  // namespace

LaneSet lanes_of(const LogData& like, const Table& tuned, double null_limit, const LaneWishes& wishes) {
  LaneSet set;
  set.base = candidate_of(tuned);
  const std::vector<FreeValue> health = free_of(like, set.base, nullptr, 0, null_limit);
  for (const FreeValue& f : health) {
    set.health.push_back(add(set, moved(set.base, f)));
    if (f.log >= 0) set.of_log.push_back(set.health.back());
  }
  if (!wishes.rows.empty()) add_rows(set, tuned, wishes.rows);
  for (const Fault* fault : fitted_faults({&like})) add_rival(set, like, *fault, null_limit, wishes.grid, health);
  for (TargetLane target : wishes.targets) {
    Lane lane{set.base, 1};
    target.fault->apply(lane.candidate.data(), target.severity);
    target.lane = add(set, std::move(lane));
    set.targets.push_back(target);
  }
  return set;
}

}  // namespace servodx
