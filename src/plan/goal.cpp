#include "plan/goal.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnose/constants.h"
#include "evidence/constants.h"
#include "plan/constants.h"

namespace servodx {
namespace {

namespace k = plan_constants;
using evidence_constants::effect_error;

double normal_below(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// A distance that settles the matter gains little by more: what is hard to tell is what the test is for.
double worth_of_distance(double squared) {
  return squared / (squared + k::half_worth) + k::beyond_doubt * std::log1p(squared);
}

struct Nearest {
  double distance = HUGE_VAL;  // squared
  std::size_t rival = 0;
  double mean_worth = 0;  // of the distances of all rivals
};

bool same(const TargetLane& target, const RivalLanes& rival) { return target.fault == rival.fault; }

Nearest nearest_of(const Information& information, const LaneSet& set, const TargetLane& target) {
  Nearest out;
  int others = 0;
  for (std::size_t b = 0; b < set.rivals.size(); ++b) {
    if (same(target, set.rivals[b])) continue;
    const double d = information.from_rival(target, b);
    out.mean_worth += worth_of_distance(d);
    ++others;
    if (d < out.distance) out.distance = d, out.rival = b;
  }
  if (others > 0) out.mean_worth /= others;
  return out;
}

std::optional<std::size_t> rival_of(const LaneSet& set, const Fault* fault) {
  for (std::size_t b = 0; b < set.rivals.size(); ++b)
    if (set.rivals[b].fault == fault) return b;
  return {};
}

double worth_of_finding(const Information& information, const LaneSet& set) {
  double sum = 0;
  for (const TargetLane& t : set.targets) {
    const Nearest nearest = nearest_of(information, set, t);
    sum += worth_of_distance(information.from_health(t.lane)) + nearest.mean_worth;
    if (std::isfinite(nearest.distance)) sum += worth_of_distance(nearest.distance);
  }
  return sum / static_cast<double>(set.targets.size());
}

// Both have to be found, but that is the lesser part.
double worth_of_parting(const Information& information, const LaneSet& set) {
  constexpr double of_finding = 0.25;
  double sum = 0;
  for (const TargetLane& t : set.targets) {
    sum += of_finding * worth_of_distance(information.from_health(t.lane));
    for (const TargetLane& other : set.targets)
      if (other.fault != t.fault)
        if (const auto rival = rival_of(set, other.fault)) sum += worth_of_distance(information.from_rival(t, *rival));
  }
  return sum;
}

double worth_of_estimating(const Information& information, const LaneSet& set) {
  double sum = 0;
  for (const RowLane& row : set.rows) sum -= std::log(std::max(1e-12, information.left_of(row)));
  return sum / static_cast<double>(set.rows.size());
}

// As `diagnose` tempers its probabilities: a fault's model errs by a part of its effect.
double temper(double effect, const FindingLaw& law) { return 1 + effect_error * effect_error * effect / law.degrees; }

// The rival's probability falls below what is listed: the difference of misfits is normal about the squared distance,
// with twice its root as deviation.
double chance_of_ruling_out(double distance, double effect, const FindingLaw& law) {
  if (!(distance > 0)) return 0;
  const double odds = (1 - diagnose_constants::ambiguous_probability) / diagnose_constants::ambiguous_probability;
  const double needed = 2 * temper(effect, law) * std::log(odds);
  return normal_below((distance - needed) / (2 * std::sqrt(distance)));
}

double deviates_of(const Information& information, const Fault& fault, int lane, const FindingLaw& law) {
  const auto usual = law.usual_gain.find(std::string(fault.name));
  const double of_health = usual == law.usual_gain.end() ? 0.0 : usual->second;
  return std::sqrt(information.from_health(lane) / (1 + of_health));
}

struct Least {
  std::optional<double> severity = {};
  bool from_mildest = false;
};

// The mildest severity from which on every one is found in 19 of 20 tests, by lines between the lanes.
Least least_on(const SeverityLanes& side, const Information& information, const Fault& fault, const FindingLaw& law) {
  const double needed = law.threshold + k::deviates_of_95_one_sided;
  Least out;
  double beyond = 0;  // deviates of the next worse
  for (std::size_t i = side.lanes.size(); i-- > 0;) {
    const double d = deviates_of(information, fault, side.lanes[i], law);
    if (d < needed) {
      if (!out.severity) return out;
      out.severity = severity_between(fault, side.severity[i], side.severity[i + 1], (needed - d) / (beyond - d));
      return out;
    }
    out.severity = side.severity[i];
    beyond = d;
  }
  out.from_mildest = true;
  return out;
}

// The side that shows less.
Least least_of(const RivalLanes& lanes, const Information& information, const FindingLaw& law) {
  Least worst = least_on(lanes.sides.front(), information, *lanes.fault, law);
  for (std::size_t i = 1; i < lanes.sides.size() && worst.severity; ++i) {
    const Least other = least_on(lanes.sides[i], information, *lanes.fault, law);
    if (!other.severity || std::abs(*other.severity) > std::abs(*worst.severity)) worst = other;
  }
  return worst;
}

PlannedTest::Fault figures_of_fault(const Information& information, const LaneSet& set, const TargetLane& t,
                                    const FindingLaw& law) {
  PlannedTest::Fault out;
  out.name = t.fault->name, out.unit = t.fault->unit, out.severity = t.severity;
  if (const auto own = rival_of(set, t.fault)) {
    const Least least = least_of(set.rivals[*own], information, law);
    out.least = least.severity, out.from_mildest = least.from_mildest;
  }
  out.deviates = deviates_of(information, *t.fault, t.lane, law);
  out.found = normal_below(out.deviates - law.threshold);
  out.named = out.found;
  const Nearest nearest = nearest_of(information, set, t);
  if (!std::isfinite(nearest.distance)) return out;
  out.nearest = set.rivals[nearest.rival].fault->name;
  out.named *= normal_below(std::sqrt(nearest.distance) / 2);
  return out;
}

double told_from(const Information& information, const LaneSet& set, const TargetLane& a, const TargetLane& b,
                 const FindingLaw& law) {
  const auto rival = rival_of(set, b.fault);
  if (!rival) return 0;
  return chance_of_ruling_out(information.from_rival(a, *rival), information.from_health(a.lane), law);
}

}  // namespace

double worth_of(const Information& information, const LaneSet& set, GoalKind kind) {
  switch (kind) {
    case GoalKind::find:
      return worth_of_finding(information, set);
    case GoalKind::part:
      return worth_of_parting(information, set);
    case GoalKind::estimate:
      return worth_of_estimating(information, set);
  }
  return 0;
}

FindingLaw usual_law(double false_alarm) {
  namespace d = diagnose_constants;
  FindingLaw law;
  // Squared gains of healthy logs are exponential about a usual mean.
  law.threshold = std::sqrt(-d::usual_gain * std::log(false_alarm * d::share_of_gain));
  return law;
}

PlannedTest::Figures figures_of(const Information& information, const LaneSet& set, GoalKind kind,
                                const FindingLaw& law) {
  PlannedTest::Figures out;
  out.information = worth_of(information, set, kind);
  for (const TargetLane& t : set.targets) out.faults.push_back(figures_of_fault(information, set, t, law));
  for (std::size_t i = 0; i < set.targets.size(); ++i)
    for (std::size_t j = i + 1; j < set.targets.size(); ++j) {
      const TargetLane &a = set.targets[i], &b = set.targets[j];
      out.pairs.push_back({std::string(a.fault->name), std::string(b.fault->name),
                           std::min(told_from(information, set, a, b, law), told_from(information, set, b, a, law))});
    }
  for (const RowLane& row : set.rows)
    out.rows.push_back({row.name, row.unit, row.before, row.before * information.left_of(row)});
  return out;
}

}  // namespace servodx
