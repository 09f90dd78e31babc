#include "prognose/trend.h"

#include <fmt/format.h>

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
constexpr std::size_t most_points = 240;  // longer histories are averaged in blocks
constexpr std::size_t looks = 40;         // moments at which an alert is looked for, evenly over the checks
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

// One check over a valve's life, as the growth model takes it: the paper's positive figures in their logarithm, where
// what temperature does is a factor; parameters as they are.
struct Series {
  std::string name, unit, cause;
  const Fault* fault = nullptr;
  bool logarithm = false;
  std::vector<GrowthPoint> points;
  std::vector<double> temperature;  // [K]

  double in(double value) const { return logarithm ? std::log(value) : value; }
  double out(double y) const { return logarithm ? std::exp(y) : y; }
  Level out(double lower, double upper) const { return {out(lower), out(upper)}; }
};

// Viscosity over that at 40 degC of a 14 mm2/s oil: only its logarithm as a regressor matters here.
double log_viscosity(double kelvin) { return std::log(oil_at(860, 14e-6, kelvin).viscosity_ratio); }

void append(Series& s, const Recording& r, const Check& c) {
  const double value = s.logarithm ? c.measured : c.value;
  if (!std::isfinite(value) || (s.logarithm && value <= 0)) return;
  GrowthPoint p;
  p.time = r.at;
  p.y = s.in(value);
  const double error = std::isfinite(c.std_error) ? c.std_error : 0.0;
  p.variance = std::pow(s.logarithm ? error / std::abs(c.value) : error, 2);
  const double z = log_viscosity(r.temperature);
  p.features = {z, z * z};
  if (s.logarithm) p.features.push_back(std::log(c.expected > 0 ? c.expected : 1.0));
  s.points.push_back(std::move(p));
  s.temperature.push_back(r.temperature);
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
        it = all.insert(all.end(), Series{c.name, c.unit, c.cause, nullptr, c.cause.empty(), {}, {}});
        if (!c.cause.empty()) it->fault = find_fault(c.cause);
      }
      append(*it, r, c);
    }
  }
  if (other_tables > 0)
    notes.push_back(fmt::format("{} checks rest on another tuned table and are left out", other_tables));
  std::erase_if(all, [](const Series& s) { return s.points.empty(); });
  return all;
}

// The row's value where the fault has failed, from its healthy value.
std::optional<double> failed_row(const Fault& fault, double healthy) {
  if (!fault.failed) return {};
  ParameterVector v(n_candidate, healthy), moved = v;
  fault.apply(moved.data(), *fault.failed);
  for (int i = 0; i < n_parameters; ++i)
    if (moved[i] != v[i]) return moved[i];
  return {};
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
      mean.time += points[i].time / n, mean.y += points[i].y / n, mean.variance += points[i].variance / n / n;
      for (std::size_t j = 0; j < mean.features.size(); ++j) mean.features[j] += points[i].features[j] / n;
    }
    out.push_back(std::move(mean));
  }
  return out;
}

GrowthPrior prior_of(const Series& s, std::size_t healthy, const Level& failure) {
  std::vector<double> y, error;
  for (std::size_t i = 0; i < healthy; ++i)
    y.push_back(s.points[i].y), error.push_back(std::sqrt(s.points[i].variance));
  GrowthPrior prior;
  prior.base = median(y);
  for (double& v : y) v = std::abs(v - prior.base);
  prior.direction = s.name == "mean_error" ? 1 : 0;
  if (failure.upper && !failure.lower) prior.direction = 1;
  if (failure.lower && !failure.upper) prior.direction = -1;
  // A growth that matters: half as much again for the paper's checks, the way to failure for a parameter.
  prior.scale = s.logarithm ? 0.5 : std::max(std::abs(prior.base), 1e-300);
  for (const std::optional<double>& level : {failure.lower, failure.upper})
    if (level && (!s.logarithm || *level > 0)) prior.scale = std::max(std::abs(s.in(*level) - prior.base), 1e-300);
  prior.noise = std::max({1.4826 * median(y), 0.3 * median(error), 1e-4 * prior.scale});
  prior.base_sd = prior.scale;
  const double swing = s.logarithm ? 0.3 : 0.3 * std::max(std::abs(prior.base), prior.noise);
  prior.feature_mean = {0.0, 0.0};
  prior.feature_sd = {swing, swing / 3};  // over three decades of viscosity: twice itself
  if (s.logarithm) {                      // the model's expectation: taken at its word within a half
    prior.feature_mean.push_back(1.0);
    prior.feature_sd.push_back(0.5);
  }
  return prior;
}

CheckTrend trend_of(const Series& s, const TrendOptions& options, std::size_t names) {
  CheckTrend out;
  out.name = s.name, out.unit = s.unit, out.cause = s.cause;
  out.state = "unknown";
  out.to_warning = infinite;
  const std::size_t n = s.points.size(), healthy = std::min(n, static_cast<std::size_t>(options.healthy));
  std::vector<double> first;
  for (std::size_t i = 0; i < healthy; ++i) first.push_back(s.points[i].y);
  out.healthy = s.out(median(first));
  if (const auto given = options.failure.find(s.name); given != options.failure.end())
    out.failure = {given->second.first, given->second.second};
  else if (const auto ratio = options.failure_ratio.find(s.name); ratio != options.failure_ratio.end())
    (ratio->second > 1 ? out.failure.upper : out.failure.lower) = ratio->second * out.healthy;
  else if (s.fault)
    if (const auto failed = failed_row(*s.fault, out.healthy))
      (*failed > out.healthy ? out.failure.upper : out.failure.lower) = failed;
  for (std::size_t i = 0; i < n; ++i)
    out.points.push_back({s.points[i].time, s.out(s.points[i].y), s.temperature[i], i < healthy});
  if (n < least_checks) return out;

  const GrowthPrior prior = prior_of(s, healthy, out.failure);
  const std::vector<GrowthPoint> all = thinned(s.points);
  const GrowthModel model(all, prior);
  const Growth& g = model.growth();
  for (std::size_t i = 0; i < n; ++i) {
    double y = s.points[i].y;
    for (std::size_t j = 0; j < g.coefficients.size(); ++j) y -= g.coefficients[j] * s.points[i].features[j];
    out.points[i].value = s.out(y);
  }

  // Levels: the spread of a single healthy check about the healthy mean.
  const GrowthModel begun({s.points.begin(), s.points.begin() + static_cast<long>(healthy)}, prior);
  std::vector<double> own, level;
  for (std::size_t i = 0; i < healthy; ++i)
    own.push_back(s.points[i].variance), level.push_back(s.in(out.points[i].value));
  const double centre = median(level);
  const double noise = begun.growth().probability < 0.5 ? begun.growth().null_noise : begun.growth().noise;
  const double spread = std::sqrt(noise * noise * (1 + 1.0 / static_cast<double>(healthy)) + median(own));
  const auto band = [&](double rate) {
    const double q = two_sided_quantile(rate) * spread;
    Level l = s.out(centre - q, centre + q);
    if (prior.direction > 0) l.lower.reset();
    if (prior.direction < 0) l.upper.reset();
    return l;
  };
  const double rate = options.false_alarm / (per_checks * static_cast<double>(names));
  out.threshold = band(options.false_alarm);
  out.warning = band(rate);
  out.healthy = s.out(centre);
  // A warning comes half way to failure at the latest; against false alarms there the trend test stands.
  const auto half_way = [&](std::optional<double>& warning, const std::optional<double>& failure, double side) {
    if (!failure) return;
    const double half = 0.5 * (out.healthy + *failure);
    if (!warning || side * (*warning - half) > 0) warning = half;
  };
  half_way(out.warning.upper, out.failure.upper, 1);
  half_way(out.warning.lower, out.failure.lower, -1);
  out.now = s.out(g.now);
  out.now_error = s.logarithm ? out.now * g.now_sd : g.now_sd;
  out.log_bayes_factor = g.log_bayes_factor;
  const double confirmed = std::log(static_cast<double>(names) / options.false_alarm);
  out.trend = g.log_bayes_factor > confirmed;
  const auto beyond = [](const Level& l, double value) {
    return (l.upper && value > *l.upper) || (l.lower && value < *l.lower);
  };
  out.slope = out.trend ? (s.logarithm ? out.now * g.slope : g.slope) : 0.0;
  out.state = "healthy";
  if (out.trend || beyond(out.threshold, out.points.back().value)) out.state = "watch";
  if (!out.trend) return out;

  // When the alert was first due, looking as the checks came in.
  const std::size_t step = std::max<std::size_t>(1, all.size() / looks);
  for (std::size_t k = std::max(healthy, least_checks); k <= all.size() && !out.alert_at; k += step) {
    const GrowthModel then({all.begin(), all.begin() + static_cast<long>(k)}, prior);
    if (then.growth().log_bayes_factor > confirmed && beyond(out.warning, s.out(then.growth().now)))
      out.alert_at = all[k - 1].time;
  }
  if (!out.alert_at && beyond(out.warning, out.now)) out.alert_at = all.back().time;
  const auto y_of = [&](const std::optional<double>& v) {
    return v && (!s.logarithm || *v > 0) ? std::optional(s.in(*v)) : std::nullopt;
  };
  const bool passed = beyond(out.warning, out.now);
  out.to_warning =
      passed ? 0.0 : quantile(model.life(y_of(out.warning.upper), y_of(out.warning.lower), options.seed), 0.5);
  if (out.alert_at && passed) out.state = "warning";
  if (!out.failure.lower && !out.failure.upper) return out;
  if (beyond(out.failure, out.now)) out.state = "failed";
  out.life = model.life(y_of(out.failure.upper), y_of(out.failure.lower), options.seed);
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

int rank_of(const std::string& state) {
  const char* order[] = {"unknown", "healthy", "watch", "warning", "failed"};
  return static_cast<int>(std::find(std::begin(order), std::end(order), state) - std::begin(order));
}

}  // namespace

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
  out.state = "unknown";
  out.to_warning = infinite;
  const std::vector<Series> all = series_of(history, out.notes);
  for (const Series& s : all) out.trends.push_back(trend_of(s, options, all.size()));

  const CheckTrend* nearest = nullptr;
  double furthest = 0;
  for (const CheckTrend& t : out.trends) {
    if (rank_of(t.state) > rank_of(out.state)) out.state = t.state;
    out.to_warning = std::min(out.to_warning, t.to_warning);
    if (t.alert_at && (!out.alert_at || *t.alert_at < *out.alert_at)) out.alert_at = t.alert_at;
    if (t.cause.empty() || !t.trend || t.life.empty()) continue;
    const double failure = t.failure.upper ? *t.failure.upper : *t.failure.lower;
    const double way = (t.now - t.healthy) / (failure - t.healthy);
    if (way > furthest) furthest = way, nearest = &t;
  }
  if (nearest) out.cause = nearest->cause;
  std::vector<std::pair<const Life*, double>> lives;
  for (const CheckTrend& t : out.trends)
    if (!t.life.empty() && (t.cause.empty() || &t == nearest)) {
      const Remaining r = remaining_of(t.life, options.coverage);
      const double width = std::isfinite(r.upper) ? std::max(r.upper - r.lower, 1e-6) : 1e6 * std::max(1.0, r.lower);
      lives.emplace_back(&t.life, 1 / (width * width));
    }
  if (!lives.empty()) {
    out.life = pooled(lives);
    out.remaining = remaining_of(out.life, options.coverage);
  }
  if (out.state == "unknown")
    out.notes.push_back(fmt::format("fewer than {} checks: no word on a trend", least_checks));
  return out;
}

}  // namespace servodx
