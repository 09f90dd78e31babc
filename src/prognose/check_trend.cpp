#include "prognose/check_trend.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "base/median.h"
#include "prognose/alert_rule.h"
#include "prognose/constants.h"
#include "prognose/failure_level.h"
#include "prognose/growth.h"
#include "prognose/healthy_levels.h"
#include "prognose/level.h"
#include "prognose/life.h"
#include "prognose/reading_scale.h"
#include "prognose/tangent_rule.h"
#include "prognose/told_points.h"
#include "prognose/trend_prior.h"

namespace servodx {

using namespace prognose_constants;

namespace {

std::size_t healthy_ones(const CheckSeries& s, const TrendSettings& options) {
  return std::min(s.points.size(), static_cast<std::size_t>(options.healthy));
}

Level failure_in_units(const FailureAt& failure, const ReadingScale& scale, double base, double size) {
  Level level;
  if (failure.upper) level.upper = scale.out(failure.level(*failure.upper, base, size));
  if (failure.lower) level.lower = scale.out(failure.level(*failure.lower, base, size));
  return level;
}

// What is told without any word on a trend.
CheckTrend as_read(const CheckSeries& s, const FailureAt& failure, std::size_t healthy) {
  CheckTrend out;
  out.name = s.name, out.unit = s.unit, out.cause = s.cause;
  out.to_warning = std::numeric_limits<double>::infinity();
  std::vector<double> first;
  for (std::size_t i = 0; i < healthy; ++i) first.push_back(s.points[i].y);
  out.healthy = s.scale.out(median(first));
  out.failure = failure_in_units(failure, s.scale, median(first), 1);
  for (std::size_t i = 0; i < s.points.size(); ++i)
    out.points.push_back({s.points[i].time, s.scale.out(s.points[i].y), s.temperature[i], i < healthy});
  return out;
}

std::vector<double> at_reference(const GrowthModel& model, const CheckSeries& s) {
  std::vector<double> corrected;
  for (const GrowthPoint& p : s.points) corrected.push_back(model.at_reference(p));
  return corrected;
}

// Since when the alert is due: by halves, as a growth that is seen stays seen.
double alert_since(const std::vector<GrowthPoint>& points, const GrowthPrior& prior, const CheckSeries& s,
                   const Level& warning, std::size_t healthy, std::size_t names, double false_alarm) {
  std::size_t not_yet = std::max(healthy, least_checks) - 1, due = points.size();
  while (due > not_yet + 1) {
    const std::size_t k = (not_yet + due) / 2;
    const GrowthModel then({points.begin(), points.begin() + static_cast<long>(k)}, prior);
    const bool so = is_confirmed(then.growth().log_bayes_factor, names, false_alarm) &&
                    warning.passed_by(s.scale.out(then.growth().now));
    (so ? due : not_yet) = k;
  }
  return points[due - 1].time;
}

// Part of the way to failure that it has come in 95 of 100 cases.
double surely_come(const Growth& g, const FailureAt& failure, const ReadingScale& scale) {
  const auto& end = g.grown > 0 ? failure.upper : failure.lower;
  if (!end) return 0;
  return scale.way(std::abs(g.grown) - one_sided * g.grown_sd) /
         scale.way(std::abs(failure.level(*end, g.base, g.size) - g.base));
}

// The paper's rule on the corrected figures; of those that fall mirrored.
std::optional<TangentRule> by_the_paper(const CheckTrend& t) {
  std::vector<double> time, value;
  const bool up = t.now > t.healthy;
  for (const auto& p : t.points) time.push_back(p.at), value.push_back(up ? p.value : -p.value);
  const auto side = [&](const Level& l) { return up ? l.upper : l.lower; };
  if (!side(t.threshold) || !side(t.warning) || !side(t.failure)) return {};
  const double sign = up ? 1 : -1;
  return tangent_rule(time, value, sign * *side(t.threshold), sign * *side(t.warning), sign * *side(t.failure));
}

}  // namespace

CheckTrend trend_of(const CheckSeries& s, const TrendSettings& options, std::size_t names) {
  const std::size_t healthy = healthy_ones(s, options);
  const FailureAt failure = failure_of(s, options);
  CheckTrend out = as_read(s, failure, healthy);
  if (s.points.size() < least_checks) return out;

  const GrowthPrior prior = prior_of(s, healthy, failure);
  const std::vector<GrowthPoint> told = told_points(s.points, prior), all = thinned(told);
  const GrowthModel model(all, prior);
  const Growth& g = model.growth();
  if (!std::isfinite(g.now)) return out;  // a ratio that reads 0 or less has no logarithm
  const std::vector<double> corrected = at_reference(model, s);
  for (std::size_t i = 0; i < corrected.size(); ++i) out.points[i].value = s.scale.out(corrected[i]);
  out.log_bayes_factor = g.log_bayes_factor;
  out.trend = is_confirmed(g.log_bayes_factor, names, options.false_alarm);

  const GrowthModel begun({told.begin(), told.begin() + static_cast<long>(healthy)}, prior);
  const HealthyChecks checks = healthy_checks(g, out.trend, begun.growth(), std::span(s.points).first(healthy),
                                              std::span(corrected).first(healthy));
  const HealthyLevels levels = healthy_levels(checks, s.scale, prior.direction, names, options.false_alarm);
  out.healthy = s.scale.out(checks.centre);
  out.failure = failure_in_units(failure, s.scale, checks.centre, g.size);
  out.warning = warned_in_time(levels.warning, out.failure, checks, s.scale);
  out.now = s.scale.out(g.now);
  out.now_error = s.scale.stretch(out.now) * g.now_sd;
  out.slope = out.trend ? s.scale.stretch(out.now) * g.slope : 0.0;

  const AlertDecision decision = decide({.confirmed = out.trend,
                                         .away = prior.direction * (g.now - g.base) < 0,
                                         .threshold = levels.threshold,
                                         .warning = out.warning,
                                         .failure = out.failure,
                                         .last = out.points.back().value,
                                         .now = out.now});
  out.state = decision.state, out.blind = decision.blind;
  if (!out.blind) out.threshold = levels.threshold;
  if (!decision.predicted) return out;
  if (decision.alert) out.alert_at = alert_since(all, prior, s, out.warning, healthy, names, options.false_alarm);
  const FailureAt at_warning{s.scale.in(out.warning.upper), s.scale.in(out.warning.lower)};
  out.to_warning = decision.alert ? 0.0 : life_quantile(model.life(at_warning, options.seed), 0.5);
  if (!out.failure.lower && !out.failure.upper) return out;
  out.surely = surely_come(g, failure, s.scale);
  out.life = model.life(failure, options.seed);
  out.remaining = remaining_of(out.life, options.coverage);
  out.tangent = by_the_paper(out);
  return out;
}

}  // namespace servodx
