#include "prognose/trend.h"

#include <fmt/format.h>
#include <omp.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "faults/registry.h"

namespace servodx {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr std::size_t least_checks = 6;   // for a word on a trend
constexpr std::size_t most_points = 100;  // longer histories are averaged in blocks
constexpr double latest_warning = 0.25;   // of the way to failure: three quarters are left to act in
constexpr double outlying = 4;            // [spreads] from its neighbours at which a check is set aside
constexpr double as_far = 0.5;            // of the furthest on its way to failure: what may be the cause instead
constexpr double per_checks = 100;        // the false-alarm rate of a valve is stated over this many checks

double median(std::vector<double> v) {
  std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
  return v[v.size() / 2];
}

// x with P(|N(0,1)| > x) = p.
double two_sided_quantile(double p) {
  double low = 0, high = 40;
  for (int k = 0; k < 80; ++k) {
    const double mid = 0.5 * (low + high);
    (std::erfc(mid / std::numbers::sqrt2) > p ? low : high) = mid;
  }
  return 0.5 * (low + high);
}

// One check over a valve's life, as the growth model takes it. The paper's positive figures in their logarithm, where
// what temperature does is a factor; a part lost (of the filter's area) by the drop over what is left, at the same
// flow, over that of the whole part: that is what a log tells, about equally well from clean to blocked, and what else
// is wrong in the pilot's path adds to it. Other parameters as they are.
struct Series {
  enum class Scale { plain, logarithm, drop };
  CheckName name;
  std::string unit, cause;
  const Fault* fault = nullptr;
  std::optional<double> tuned;       // the row's value in the table that the checks rest on
  std::optional<double> per_newton;  // [A/N] of the spool's friction
  Scale scale = Scale::plain;
  double clean = 1;    // drop over the whole part, in that of the table's whole part
  ReadingCurve curve;  // of valves with known wear, where there is one
  std::vector<GrowthPoint> points;
  std::vector<double> temperature;  // [K]

  static constexpr double most_lost = 0.999;
  // Below half of the drop over the whole part a reading ends: from there on straight, so that every drop has a part.
  static constexpr double least_drop = 0.5;
  static double lost_at(double drop) {
    const double from = std::max(drop, least_drop);
    return 1 - 1 / std::sqrt(from) + (drop - from) * lost_per_drop(drop);
  }
  static double lost_per_drop(double drop) { return 0.5 * std::pow(std::max(drop, least_drop), -1.5); }
  static double drop_at(double lost) {
    const double from = std::clamp(lost, lost_at(least_drop), most_lost);
    return 1 / ((1 - from) * (1 - from)) + std::min(0.0, lost - from) / lost_per_drop(least_drop);
  }
  bool paper() const { return scale == Scale::logarithm; }
  double in(double v) const {
    return scale == Scale::logarithm ? std::log(v) : scale == Scale::drop ? drop_at(v) / clean : v;
  }
  double out(double y) const {
    return scale == Scale::logarithm ? std::exp(y) : scale == Scale::drop ? lost_at(y * clean) : y;
  }
  // d out / d y at a value.
  double stretch(double v) const {
    return scale == Scale::logarithm ? std::abs(v) : scale == Scale::drop ? lost_per_drop(drop_at(v)) * clean : 1.0;
  }
  // How far a growth has come where its error matters as much at the first as at the last: of a drop its logarithm.
  double way(double grown) const { return scale == Scale::drop ? std::log1p(std::max(grown, 0.0)) : grown; }
  // The growth when a part of the way has been worn; of a drop it is the part lost that wears.
  double worn(double part, double grown) const {
    return scale == Scale::drop ? drop_at(part * lost_at(1 + std::max(grown, 0.0))) - 1 : part * grown;
  }
  std::optional<double> in(const std::optional<double>& v) const {
    return v && (!paper() || *v > 0) ? std::optional(in(*v)) : std::nullopt;
  }
  Level out(double lower, double upper) const { return {out(lower), out(upper)}; }
};

constexpr std::size_t reach = 3;  // neighbours to either side

double median_of_neighbours(const std::vector<double>& y, std::size_t i) {
  std::vector<double> near;
  for (std::size_t k = i >= reach ? i - reach : 0; k < std::min(y.size(), i + reach + 1); ++k)
    if (k != i) near.push_back(y[k]);
  return median(near);
}

// Part of what is wrong beside a filter, as a drop over the clean one, that shows in thick oil: the drop over a fine
// screen is half laminar at 40 degC and all but laminar in the cold, that over the bores beside it is not.
double beside_laminar(double log_viscosity) { return 1 / (0.5 + 0.5 * std::exp(log_viscosity)); }

void append(Series& s, const Recording& r, const Check& c) {
  const double value = s.paper() ? c.measured : c.value;
  if (!std::isfinite(value) || (s.paper() && value <= 0)) return;
  GrowthPoint p;
  p.time = r.at;
  p.y = s.in(value);
  const double error = std::isfinite(c.std_error) ? c.std_error : 0.0;
  p.variance = std::pow(error / s.stretch(c.value), 2);
  const double z = std::isfinite(r.temperature) ? log_viscosity(r.temperature) : 0.0;
  p.features = {z, z * z};
  if (s.paper()) p.features.push_back(std::log(c.expected > 0 ? c.expected : 1.0));
  if (s.scale == Series::Scale::drop) {
    constexpr double near = 1.001;
    p.at_most = p.y < near * Series::least_drop;
    p.base_shown = beside_laminar(z), p.features.push_back(1 - p.base_shown);
  }
  s.points.push_back(std::move(p));
  s.temperature.push_back(r.temperature);
}

// What follows from the name of a figure and the valve's table. A figure that is not always positive has no logarithm.
Series begun(const Check& check, const ValveHistory& history) {
  Series s;
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
    if (s.fault && s.fault->part_lost) s.scale = Series::Scale::drop;
    return s;
  }
  const auto positive = [&](const Recording& r) {
    return std::all_of(r.checks.begin(), r.checks.end(),
                       [&](const Check& c) { return c.name != check.name || !(c.measured <= 0); });
  };
  if (check.name.kind() != CheckKind::parameter &&
      std::all_of(history.recordings.begin(), history.recordings.end(), positive))
    s.scale = Series::Scale::logarithm;
  return s;
}

std::vector<Series> series_of(const ValveHistory& history, std::vector<std::string>& notes) {
  std::vector<Series> all;
  if (history.recordings.empty()) return all;
  const std::string& table = history.recordings.back().table_sha256;
  std::size_t other_tables = 0;
  for (const Recording& r : history.recordings) {
    if (r.table_sha256 != table) {
      ++other_tables;
      continue;
    }
    for (const Check& c : r.checks) {
      const bool renewed = std::any_of(history.events.begin(), history.events.end(),
                                       [&](const Event& e) { return e.at > r.at && resets(e.kind, c); });
      if (renewed) continue;
      auto it = std::find_if(all.begin(), all.end(), [&](const Series& s) { return s.name == c.name; });
      if (it == all.end()) {
        it = all.insert(all.end(), begun(c, history));
      }
      append(*it, r, c);
    }
  }
  if (other_tables > 0)
    notes.push_back(fmt::format("{} checks rest on another tuned table and are left out", other_tables));
  std::erase_if(all, [](const Series& s) { return s.points.empty(); });
  return all;
}

// A table that no data sheet and no log gave the screen's own size reads a clean one as partly blocked. Where health
// reads further from the table's than two deviations of what is left open (a clean drop by the bores, a quarter by the
// screen), that is the clean drop, and wear is of it.
void take_clean(Series& s, std::size_t healthy) {
  const double left_open = std::hypot(1.0, 0.25);
  std::vector<double> first;
  for (std::size_t i = 0; i < std::min(healthy, s.points.size()); ++i) first.push_back(s.points[i].y);
  const double read = median(first);
  if (s.scale != Series::Scale::drop || read < 1 + 2 * left_open) return;
  s.clean = read;
  for (GrowthPoint& p : s.points) p.y /= read, p.variance /= read * read;
}

// Readings as the wear at which valves with parts of known wear read the same, in the coordinate of the growth.
void take_seeded(Series& s, const std::vector<SeededReading>& seeded) {
  std::vector<SeededReading> of_this;
  for (SeededReading r : seeded)
    if (r.check == s.name) r.truth = s.in(r.truth), r.reading = s.in(r.reading), of_this.push_back(std::move(r));
  if (of_this.empty()) return;
  s.curve = ReadingCurve(of_this, s.scale == Series::Scale::drop ? std::optional(0.0) : std::nullopt);
  for (GrowthPoint& p : s.points) {
    const ReadingCurve::Worn worn = s.curve.at(p.y, p.features[0]);
    p.y = worn.truth, p.variance = worn.per_reading * worn.per_reading * p.variance + worn.error * worn.error;
  }
  if (s.tuned) s.tuned = s.out(s.curve.at(s.in(*s.tuned), 0).truth);
}

// The value of a fault's row where it has failed: for severities that multiply, of what it was.
std::optional<double> failed_row(const Fault& fault) {
  if (!fault.failed) return {};
  const double healthy = fault.log_scale ? 1.0 : 0.0;
  ParameterVector v(n_candidate, healthy), moved = v;
  fault.apply(moved.data(), *fault.failed);
  for (int i = 0; i < n_parameters; ++i)
    if (moved[i] != v[i]) return moved[i];
  return {};
}

// What the model's form leaves open of a severity at a value of its row, in the coordinate of the growth: it reads a
// level, whoever set it, no better than that.
double left_open(const Series& s, double value) {
  return s.fault->log_scale ? s.fault->spread * std::abs(value) : s.fault->spread;
}

// The fault's own, in the coordinate of the growth; none of the paper's checks.
FailureAt own_failure(const Series& s) {
  FailureAt at;
  const auto failed = s.fault ? failed_row(*s.fault) : std::nullopt;
  if (!failed) return at;
  auto& side = *failed > (s.fault->log_scale ? 1 : 0) ? at.upper : at.lower;
  // A severity that multiplies does so to the tuned value; what the estimate errs by in health it errs by later.
  if (s.fault->log_scale && s.tuned) {
    at.of = FailureAt::Of::beyond_base;
    at.sd = left_open(s, *failed * *s.tuned);
    side = (*failed - 1) * *s.tuned;
    return at;
  }
  if (s.fault->log_scale) at.of = FailureAt::Of::times_base;
  // Of what was open at the beginning: how large a clean filter is stands on no data sheet, and no log tells it.
  if (s.fault->part_lost) at.of = FailureAt::Of::beyond_base;
  if (!s.fault->log_scale) at.sd = left_open(s, *failed);
  side = s.fault->part_lost ? Series::drop_at(*failed) - 1 : s.in(*failed);
  return at;
}

// From the user, from a limit, or from the fault itself; in the coordinate of the growth.
FailureAt failure_of(const Series& s, const TrendOptions& options) {
  FailureAt at;
  const auto to_side = [&](double value, bool up) { (up ? at.upper : at.lower) = value; };
  // How well a level is known at a value of the row: as who set it says, else as the model's form allows.
  const auto known_to = [&](double value, double unit) {
    const auto stated = options.failure_spread.find(s.name);
    if (stated != options.failure_spread.end()) return stated->second * unit;
    return s.curve.empty() ? left_open(s, value) : s.curve.spread(s.in(value)) * s.stretch(value);
  };
  if (const auto given = options.failure.find(s.name); given != options.failure.end()) {
    at.lower = s.in(given->second.first), at.upper = s.in(given->second.second);
    if (const auto& level = at.upper ? at.upper : at.lower; level && s.fault) at.sd = known_to(s.out(*level), 1);
  } else if (const auto current = options.failure_current.find(s.name);
             current != options.failure_current.end() && s.per_newton) {
    at.upper = current->second / *s.per_newton;
    at.sd = known_to(*at.upper, 1 / *s.per_newton);
  } else if (const auto ratio = options.failure_ratio.find(s.name); ratio != options.failure_ratio.end()) {
    if (s.fault && s.fault->log_scale && s.tuned) {  // its healthy checks may hardly see it: the tuning logs saw more
      to_side(ratio->second * *s.tuned, ratio->second > 1);
      at.sd = known_to(ratio->second * *s.tuned, *s.tuned);
      return at;
    }
    at.of = s.paper() ? FailureAt::Of::beyond_base : FailureAt::Of::times_base;
    to_side(s.paper() ? std::log(ratio->second) : ratio->second, ratio->second > 1);
  } else {
    return own_failure(s);
  }
  return at;
}

std::vector<GrowthPoint> thinned(const std::vector<GrowthPoint>& points) {
  if (points.size() <= most_points) return points;
  std::vector<GrowthPoint> out;
  for (std::size_t b = 0; b < most_points; ++b) {
    const std::size_t from = b * points.size() / most_points, to = (b + 1) * points.size() / most_points;
    GrowthPoint mean;
    mean.features.assign(points[from].features.size(), 0.0);
    const auto n = static_cast<double>(to - from);
    for (std::size_t i = from; i < to; ++i) {
      mean.exposed += points[i].exposed / n, mean.stretch += (points[i].stretch - 1) / n;
      mean.base_shown += (points[i].base_shown - 1) / n;
      mean.time += points[i].time / n, mean.y += points[i].y / n, mean.variance += points[i].variance / n / n;
      for (std::size_t j = 0; j < mean.features.size(); ++j) mean.features[j] += points[i].features[j] / n;
    }
    out.push_back(std::move(mean));
  }
  return out;
}

GrowthPrior prior_of(const Series& s, std::size_t healthy, const FailureAt& failure) {
  std::vector<double> y, error;
  for (std::size_t i = 0; i < healthy; ++i)
    y.push_back(s.points[i].y), error.push_back(std::sqrt(s.points[i].variance));
  GrowthPrior prior;
  prior.base = median(y);
  for (double& v : y) v = std::abs(v - prior.base);
  prior.direction = s.name.kind() == CheckKind::mean_error ? 1 : 0;
  if (failure.upper && !failure.lower) prior.direction = 1;
  if (failure.lower && !failure.upper) prior.direction = -1;
  // A growth that matters: half as much again for the paper's checks, the way to failure for a parameter.
  const auto way = [&](const FailureAt& end) {
    double scale = s.paper() ? 0.5 : std::max(std::abs(prior.base), 1e-300);
    for (const std::optional<double>& level : {end.lower, end.upper})
      if (level) scale = std::max(std::abs(end.level(*level, prior.base) - prior.base), 1e-300);
    return scale;
  };
  prior.scale =
      std::max(way(failure), 0.5 * way(own_failure(s)));  // a level near health keeps nothing from growing past it
  prior.noise = std::max({1.4826 * median(y), 0.3 * median(error), 1e-4 * prior.scale});
  prior.base_sd = prior.scale;
  prior.of_drop = s.scale == Series::Scale::drop;
  // What cold oil does to the estimate of a severity that adds knows nothing of the healthy value.
  const bool adds = s.fault && !s.fault->log_scale;
  const double swing = s.paper() ? 0.3 : 0.3 * (adds ? prior.scale : std::max(std::abs(prior.base), prior.noise));
  prior.feature_mean = {0.0, 0.0};
  prior.feature_sd = {swing, swing / 3};  // over three decades of viscosity: twice itself
  prior.tilt = 0.15;                      // over three e-folds of viscosity: half of itself
  if (s.paper()) {                        // the model's expectation: taken at its word within a half
    prior.feature_mean.push_back(1.0);
    prior.feature_sd.push_back(0.5);
  }
  if (prior.of_drop) {
    // It begins with all of it. Bores known to 2 % leave open as much of the pilot's supply as a clean screen takes;
    // in thick oil, where the screen takes the most of it, half of that.
    prior.base = 1, prior.base_sd = 1;
    prior.feature_mean = {0.0, 0.0, 1.0};
    prior.feature_sd = {0.0, 0.0, 0.5};
    prior.tilt = 0.3;  // how much of a screen's drop is laminar is on no data sheet: twice itself over three e-folds
  }
  prior.scatter = 0.15;
  if (const auto& valves = s.curve.differing()) {
    prior.tilt = std::min(prior.tilt, valves->tilt);
    prior.size_sd = std::min(prior.size_sd, valves->size);
  }
  return prior;
}

// What the oil may change of a check, and what of its figure a unit of wear is there.
void expose(std::vector<GrowthPoint>& points, const GrowthPrior& prior) {
  std::vector<double> y;
  for (const GrowthPoint& p : points) y.push_back(p.y);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double near = median_of_neighbours(y, i), drop = std::max(near, 1.0);
    points[i].exposed = std::abs((prior.of_drop ? drop : near - prior.base) * points[i].features[0]);
    if (prior.of_drop) points[i].stretch = 1 / Series::lost_per_drop(drop);
  }
}

// A drop is tried in many parts lost: where only the curve through the checks is asked for, in fewer.
GrowthPrior first_look(GrowthPrior prior) {
  prior.coarse = prior.of_drop;
  return prior;
}

// Where the scale of what is lost ends a reading says: at most this. The normal reading that says as much to the curve
// that all tell together (Newton's step of the likelihood of a censored reading).
std::vector<GrowthPoint> at_the_end(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  constexpr int steps = 2;
  const std::vector<GrowthPoint> as_read = points;
  const auto at_most = [](const GrowthPoint& p) { return p.at_most; };
  for (int k = 0; k < steps && std::any_of(as_read.begin(), as_read.end(), at_most); ++k) {
    const GrowthModel all(thinned(points), first_look(prior));
    for (std::size_t i = 0; i < points.size(); ++i) {
      const GrowthPoint& p = as_read[i];
      if (!p.at_most) continue;
      const double sigma = std::hypot(std::sqrt(p.variance), all.growth().noise);
      const double curve = all.expected(p), z = (p.y - curve) / sigma;
      const double ratio = std::exp(-0.5 * z * z) * std::numbers::sqrt2 / std::sqrt(std::numbers::pi) /
                           std::max(std::erfc(-z / std::numbers::sqrt2), 1e-300);
      const double bend = std::clamp(ratio * (z + ratio), 1e-3, 1.0);
      points[i].y = curve - sigma * ratio / bend;
      points[i].variance = p.variance + sigma * sigma * (1 / bend - 1);
    }
  }
  return points;
}

// One check alone raises no alert: what lies far from its neighbours, before and after it, weighs as little as it is
// far from them, until others join it. Their spread is that of all checks about their neighbours.
std::vector<GrowthPoint> set_aside(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  if (points.size() < least_checks) return points;
  expose(points, prior);
  const GrowthModel first(thinned(points), first_look(prior));
  std::vector<double> corrected;
  for (const GrowthPoint& p : points) corrected.push_back(first.at_reference(p));
  std::vector<double> away;
  for (std::size_t i = 0; i < points.size(); ++i)
    away.push_back(std::abs(corrected[i] - median_of_neighbours(corrected, i)));
  const double spread = std::max(1.4826 * median(away), 1e-300);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (away[i] > outlying * std::hypot(spread, std::sqrt(points[i].variance))) points[i].variance += away[i] * away[i];
  return points;
}

CheckTrend trend_of(const Series& s, const TrendOptions& options, std::size_t names) {
  CheckTrend out;
  out.name = s.name, out.unit = s.unit, out.cause = s.cause;
  out.to_warning = infinite;
  const std::size_t n = s.points.size(), healthy = std::min(n, static_cast<std::size_t>(options.healthy));
  std::vector<double> first;
  for (std::size_t i = 0; i < healthy; ++i) first.push_back(s.points[i].y);
  const FailureAt failure = failure_of(s, options);
  const auto fails_at = [&](double base, double size) {
    Level level;
    if (failure.upper) level.upper = s.out(failure.level(*failure.upper, base, size));
    if (failure.lower) level.lower = s.out(failure.level(*failure.lower, base, size));
    return level;
  };
  out.healthy = s.out(median(first));
  out.failure = fails_at(median(first), 1);
  for (std::size_t i = 0; i < n; ++i)
    out.points.push_back({s.points[i].time, s.out(s.points[i].y), s.temperature[i], i < healthy});
  if (n < least_checks) return out;

  const GrowthPrior prior = prior_of(s, healthy, failure);
  const std::vector<GrowthPoint> told = at_the_end(set_aside(s.points, prior), prior);
  const std::vector<GrowthPoint> all = thinned(told);
  const GrowthModel model(all, prior);
  const Growth& g = model.growth();
  if (!std::isfinite(g.now)) return out;  // a ratio that reads 0 or less has no logarithm
  std::vector<double> corrected;
  for (std::size_t i = 0; i < n; ++i) {
    corrected.push_back(model.at_reference(s.points[i]));
    out.points[i].value = s.out(corrected.back());
  }
  out.log_bayes_factor = g.log_bayes_factor;
  const double confirmed = std::log(static_cast<double>(names) / options.false_alarm);
  out.trend = g.log_bayes_factor > confirmed;

  // Levels: the spread of a single healthy check about where the figure began. What grows from the first check on began
  // below its first checks.
  const GrowthModel begun({told.begin(), told.begin() + static_cast<long>(healthy)}, prior);
  std::vector<double> own;
  for (std::size_t i = 0; i < healthy; ++i) own.push_back(s.points[i].variance);
  double centre = out.trend ? g.base : median({corrected.begin(), corrected.begin() + static_cast<long>(healthy)});
  const double noise = begun.growth().probability < 0.5 ? begun.growth().null_noise : begun.growth().noise;
  const double spread = std::sqrt(noise * noise * (1 + 1.0 / static_cast<double>(healthy)) + median(own));
  const auto band = [&](double rate) {
    const double q = two_sided_quantile(rate) * spread;
    Level l = s.out(centre - q, centre + q);
    if (prior.direction > 0) l.lower.reset();
    if (prior.direction < 0) l.upper.reset();
    return l;
  };
  out.healthy = s.out(centre);
  out.failure = fails_at(centre, g.size);
  out.threshold = band(options.false_alarm);
  out.warning = band(options.false_alarm / (per_checks * static_cast<double>(names)));
  const auto beyond = [](const Level& l, double value) {
    return (l.upper && value > *l.upper) || (l.lower && value < *l.lower);
  };
  // Where health alone scatters beyond failure one check says nothing at this false-alarm rate: only a trend can.
  out.blind = (out.threshold.upper && out.failure.upper && *out.threshold.upper >= *out.failure.upper) ||
              (out.threshold.lower && out.failure.lower && *out.threshold.lower <= *out.failure.lower);
  if (out.blind) out.threshold = {};
  // A warning comes at a part of the way to failure at the latest; against false alarms there the trend test stands.
  const auto in_time = [&](std::optional<double>& warning, const std::optional<double>& end, double side) {
    if (!end) return;
    const double latest = s.out(centre + s.worn(latest_warning, s.in(*end) - centre));
    if (!warning || side * (*warning - latest) > 0) warning = latest;
  };
  in_time(out.warning.upper, out.failure.upper, 1);
  in_time(out.warning.lower, out.failure.lower, -1);
  out.now = s.out(g.now);
  out.now_error = s.stretch(out.now) * g.now_sd;
  out.slope = out.trend ? s.stretch(out.now) * g.slope : 0.0;
  out.state = out.blind ? TrendState::blind : TrendState::healthy;
  if (out.trend || beyond(out.threshold, out.points.back().value)) out.state = TrendState::watch;
  if (!out.trend || prior.direction * (g.now - g.base) < 0) return out;  // away from failure is no way to it

  // Since when the alert is due: by halves, as a growth that is seen stays seen.
  if (beyond(out.warning, out.now)) {
    std::size_t not_yet = std::max(healthy, least_checks) - 1, due = all.size();
    while (due > not_yet + 1) {
      const std::size_t k = (not_yet + due) / 2;
      const GrowthModel then({all.begin(), all.begin() + static_cast<long>(k)}, prior);
      const bool so = then.growth().log_bayes_factor > confirmed && beyond(out.warning, s.out(then.growth().now));
      (so ? due : not_yet) = k;
    }
    out.alert_at = all[due - 1].time;
  }
  const bool passed = out.alert_at.has_value();
  out.to_warning =
      passed ? 0.0 : quantile(model.life({s.in(out.warning.upper), s.in(out.warning.lower)}, options.seed), 0.5);
  if (passed) out.state = TrendState::warning;
  if (!out.failure.lower && !out.failure.upper) return out;
  if (beyond(out.failure, out.now)) out.state = TrendState::failed;
  if (const auto& end = g.grown > 0 ? failure.upper : failure.lower) {
    constexpr double one_sided = 1.645;  // 95 %
    out.surely = s.way(std::abs(g.grown) - one_sided * g.grown_sd) /
                 s.way(std::abs(failure.level(*end, g.base, g.size) - g.base));
  }
  out.life = model.life(failure, options.seed);
  out.remaining = remaining_of(out.life, options.coverage);

  std::vector<double> time, value;
  const bool up = out.now > out.healthy;
  for (const auto& p : out.points) time.push_back(p.at), value.push_back(up ? p.value : -p.value);
  const auto side = [&](const Level& l) { return up ? l.upper : l.lower; };
  if (side(out.threshold) && side(out.warning) && side(out.failure)) {
    const double sign = up ? 1 : -1;
    out.tangent =
        tangent_rule(time, value, sign * *side(out.threshold), sign * *side(out.warning), sign * *side(out.failure));
  }
  return out;
}

// Mixture of lives, each with its weight, as equally likely hours.
Life pooled(const std::vector<std::pair<const Life*, double>>& lives) {
  std::vector<std::pair<double, double>> all;
  double total = 0;
  for (const auto& [life, weight] : lives)
    for (double t : *life) all.emplace_back(t, weight / static_cast<double>(life->size())), total += all.back().second;
  std::sort(all.begin(), all.end());
  Life out;
  constexpr int kept = 200;
  double sum = 0;
  std::size_t i = 0;
  for (int q = 0; q < kept; ++q) {
    const double target = (q + 0.5) / kept * total;
    while (i + 1 < all.size() && sum + all[i].second < target) sum += all[i].second, ++i;
    out.push_back(all[i].first);
  }
  return out;
}

}  // namespace

double friction_current(const std::vector<double>& tuned) {
  const double nozzle = tuned.at(row::hydraulic_amplifier_gain) / std::numbers::pi;
  return std::pow(nozzle / tuned.at(row::spool_diameter), 2) / tuned.at(row::torque_motor_gain);
}

Remaining remaining_of(const Life& life, double coverage) {
  return {quantile(life, 0.5), quantile(life, 0.5 - coverage / 2), quantile(life, 0.5 + coverage / 2)};
}

std::optional<TangentRule> tangent_rule(const std::vector<double>& time, const std::vector<double>& value,
                                        double threshold, double warning, double failure) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  int beyond = 0;
  double first = 0, scale = 1;
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (!(value[k] > threshold)) continue;
    if (beyond == 0) first = time[k], scale = std::max(1e-12, time.back() - first);
    const double s = (time[k] - first) / scale;
    const Eigen::Vector3d row(1, s, s * s);
    normal += row * row.transpose();
    right += row * value[k];
    if (++beyond < 4) continue;  // a quadratic through three points is no fit
    const Eigen::Vector3d c = normal.ldlt().solve(right);
    const double curve = c[0] + c[1] * s + c[2] * s * s, slope = (c[1] + 2 * c[2] * s) / scale;
    if (curve >= warning && slope > 0) return TangentRule{time[k], (failure - warning) / slope};
  }
  return {};
}

ValveTrend trend(const ValveHistory& history, const TrendOptions& options) {
  ValveTrend out;
  out.valve = history.valve;
  out.serial = history.serial;
  out.checks = history.recordings.size();
  out.at = history.recordings.empty() ? 0.0 : history.recordings.back().at;
  out.to_warning = infinite;
  std::vector<Series> all = series_of(history, out.notes);
  for (Series& s : all) take_seeded(s, options.seeded), take_clean(s, static_cast<std::size_t>(options.healthy));
  out.trends.resize(all.size());
  const auto series = static_cast<long>(all.size());
  const int threads = options.threads > 0 ? options.threads : omp_get_max_threads();
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads)
  for (long k = 0; k < series; ++k)
    out.trends[static_cast<std::size_t>(k)] = trend_of(all[static_cast<std::size_t>(k)], options, all.size());
  for (const Series& s : all)
    if (options.failure_current.contains(s.name) && !s.per_newton)
      out.notes.push_back(fmt::format("{}: no tuned table says what friction takes that current", s.name.text()));

  for (std::size_t k = 0; k < all.size(); ++k) {
    const CheckTrend& t = out.trends[k];
    if ((t.failure.upper && t.healthy > *t.failure.upper) || (t.failure.lower && t.healthy < *t.failure.lower))
      out.notes.push_back(t.name.text() + ": its first checks are beyond its failure level already");
    if (options.failure_ratio.contains(t.name) && all[k].fault && !all[k].fault->log_scale)
      out.notes.push_back(t.name.text() + ": does not multiply, so its level is so many times its first checks");
  }

  double furthest = -infinite;  // of what may be the cause, surely
  const auto may_be = [](const CheckTrend& t) { return !t.cause.empty() && t.trend && !t.life.empty(); };
  for (const CheckTrend& t : out.trends) {
    out.state = std::max(out.state, t.state);
    out.to_warning = std::min(out.to_warning, t.to_warning);
    if (t.alert_at && (!out.alert_at || *t.alert_at < *out.alert_at)) out.alert_at = t.alert_at;
    if (may_be(t)) furthest = std::max(furthest, t.surely);
  }
  const CheckTrend* cause = nullptr;
  for (const CheckTrend& t : out.trends)
    if (may_be(t) && t.surely >= std::min(furthest, as_far * furthest) &&
        (!cause || t.log_bayes_factor > cause->log_bayes_factor))
      cause = &t;
  if (cause) out.cause = cause->cause;
  for (const CheckTrend& t : out.trends)
    if (t.blind && !t.trend)
      out.notes.push_back(fmt::format(
          "{}: a healthy check scatters beyond the failure level at this false-alarm rate; only a trend can warn",
          t.name.text()));
  std::vector<std::pair<const Life*, double>> lives;
  for (const CheckTrend& t : out.trends)
    if (!t.life.empty() && (cause ? &t == cause : t.cause.empty())) {
      const Remaining r = remaining_of(t.life, options.coverage);
      const double width = std::isfinite(r.upper) ? std::max(r.upper - r.lower, 1e-6) : 1e6 * std::max(1.0, r.lower);
      lives.emplace_back(&t.life, 1 / (width * width));
    }
  if (!lives.empty()) {
    out.life = pooled(lives);
    out.remaining = remaining_of(out.life, options.coverage);
  }
  for (const CheckTrend& t : out.trends)
    if (t.state == TrendState::unknown && t.points.size() >= least_checks)
      out.notes.push_back(t.name.text() +
                          ": holds a reading that none can be, 0 or less of a ratio: no word on a trend");
  if (out.state == TrendState::unknown && out.checks < least_checks)
    out.notes.push_back(fmt::format("fewer than {} checks: no word on a trend", least_checks));
  return out;
}

}  // namespace servodx
