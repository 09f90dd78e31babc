#include "prognose/check_series.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

#include "base/median.h"
#include "faults/registry.h"
#include "parameters/list.h"
#include "prognose/check.h"
#include "prognose/constants.h"
#include "prognose/track.h"

namespace servodx {

using namespace prognose_constants;

namespace {

// Part of what is wrong beside a filter, as a drop over the clean one, that shows in thick oil: the drop over a fine
// screen is half laminar at 40 degC and all but laminar in the cold, that over the bores beside it is not.
double beside_laminar(double log_viscosity) {
  return 1 / (laminar_part + (1 - laminar_part) * std::exp(log_viscosity));
}

void append(CheckSeries& s, const Recording& r, const Check& c) {
  // As it was in this log's oil; a value that is none is told by what was measured.
  const double as_it_was = c.value > 0 ? c.value * c.expected : c.measured;
  const double value = s.scale.paper() ? as_it_was : c.value;
  if (!std::isfinite(value) || (s.scale.paper() && value <= 0)) return;
  GrowthPoint p;
  p.time = r.at;
  p.y = s.scale.in(value);
  const double error = std::isfinite(c.std_error) ? c.std_error : 0.0;
  p.variance = std::pow(error / s.scale.stretch(c.value), 2);
  const double z = std::isfinite(r.temperature) ? log_viscosity(r.temperature) : 0.0;
  p.features = {z, z * z};
  if (s.scale.paper()) p.features.push_back(std::log(c.expected > 0 ? c.expected : 1.0));
  if (s.scale.of_drop()) {
    p.at_most = p.y < at_end * ReadingScale::least_drop;
    p.base_shown = beside_laminar(z), p.features.push_back(1 - p.base_shown);
  }
  s.points.push_back(std::move(p));
  s.temperature.push_back(r.temperature);
}

// A figure that is not always positive has no logarithm.
bool always_positive(const CheckName& name, const ValveHistory& history) {
  return std::all_of(history.recordings.begin(), history.recordings.end(), [&](const Recording& r) {
    return std::all_of(r.checks.begin(), r.checks.end(),
                       [&](const Check& c) { return c.name != name || !(c.measured <= 0); });
  });
}

// What follows from the name of a figure and the valve's table.
CheckSeries begun(const Check& check, const ValveHistory& history) {
  CheckSeries s;
  s.name = check.name, s.unit = check.unit, s.cause = check.cause;
  for (const Progressive& p : progressive_faults())
    if (check.name.row() == p.row) {
      if (s.cause.empty()) s.cause = p.fault->name;
      if (static_cast<std::size_t>(p.row) < history.tuned.size())
        s.tuned = history.tuned[static_cast<std::size_t>(p.row)];
      if (s.tuned && p.row == row::spool_friction) s.per_newton = friction_current(history.tuned);
    }
  if (!s.cause.empty()) {
    s.fault = find_fault(s.cause);
    if (s.fault && s.fault->part_lost) s.scale.kind = ReadingScale::Kind::drop;
    return s;
  }
  if (check.name.kind() != CheckKind::parameter && always_positive(check.name, history))
    s.scale.kind = ReadingScale::Kind::logarithm;
  return s;
}

bool renewed_after(const Recording& r, const Check& c, const ValveHistory& history) {
  return std::any_of(history.events.begin(), history.events.end(),
                     [&](const Event& e) { return e.at > r.at && resets(e.kind, c); });
}

}  // namespace

double friction_current(const std::vector<double>& tuned) {
  const double nozzle = tuned.at(row::hydraulic_amplifier_gain) / std::numbers::pi;
  return std::pow(nozzle / tuned.at(row::spool_diameter), 2) / tuned.at(row::torque_motor_gain);
}

SeriesOfValve series_of(const ValveHistory& history) {
  SeriesOfValve out;
  if (history.recordings.empty()) return out;
  const std::string& table = history.recordings.back().table_sha256;
  for (const Recording& r : history.recordings) {
    if (r.table_sha256 != table) {
      ++out.of_other_tables;
      continue;
    }
    for (const Check& c : r.checks) {
      if (renewed_after(r, c, history)) continue;
      auto it =
          std::find_if(out.checks.begin(), out.checks.end(), [&](const CheckSeries& s) { return s.name == c.name; });
      if (it == out.checks.end()) it = out.checks.insert(out.checks.end(), begun(c, history));
      append(*it, r, c);
    }
  }
  std::erase_if(out.checks, [](const CheckSeries& s) { return s.points.empty(); });
  return out;
}

void take_clean(CheckSeries& s, std::size_t healthy) {
  std::vector<double> first;
  for (std::size_t i = 0; i < std::min(healthy, s.points.size()); ++i) first.push_back(s.points[i].y);
  const double read = median(first);
  if (!s.scale.of_drop() || read < 1 + no_such_screen * std::hypot(left_by_bores, left_by_screen)) return;
  s.scale.clean = read;
  for (GrowthPoint& p : s.points) p.y /= read, p.variance /= read * read;
}

void take_seeded(CheckSeries& s, const std::vector<SeededReading>& seeded) {
  std::vector<SeededReading> of_this;
  for (SeededReading r : seeded)
    if (r.check == s.name)
      r.truth = s.scale.in(r.truth), r.reading = s.scale.in(r.reading), of_this.push_back(std::move(r));
  if (of_this.empty()) return;
  s.curve = ReadingCurve(of_this, s.scale.of_drop() ? std::optional(0.0) : std::nullopt);
  for (GrowthPoint& p : s.points) {
    const ReadingCurve::Worn worn = s.curve.at(p.y, p.features[0]);
    p.y = worn.truth, p.variance = worn.per_reading * worn.per_reading * p.variance + worn.error * worn.error;
  }
  if (s.tuned) s.tuned = s.scale.out(s.curve.at(s.scale.in(*s.tuned), 0).truth);
}

}  // namespace servodx
