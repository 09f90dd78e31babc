#include "prognose/growth.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/random.h"

namespace servodx {
namespace {

struct Law {
  double power = 1;     // s^power
  double exponent = 0;  // else (exp(k s) - 1) / (exp(k) - 1)
  double weight = 1;    // before any data
  double at(double s) const {
    if (s <= 0) return 0;
    return exponent > 0 ? std::expm1(exponent * s) / std::expm1(exponent) : std::pow(s, power);
  }
  double inverse(double g) const {
    return exponent > 0 ? std::log1p(g * std::expm1(exponent)) / exponent : std::pow(g, 1 / power);
  }
  double slope_at_1() const { return exponent > 0 ? exponent * std::exp(exponent) / std::expm1(exponent) : power; }
};

// Wear at constant duty is linear; dirt and chemistry are not known to be. Linear has the weight of all others of a
// side.
constexpr std::array<Law, 8> laws = {
    {{0.5, 0, 1}, {0.7, 0, 1}, {1.0, 0, 6}, {1.4, 0, 1}, {2.0, 0, 1}, {3.0, 0, 1}, {1, 2.5, 1}, {1, 5.0, 1}}};
// Onsets as parts of the record, and their weights: wear usually begins with use. Between coarser ones a growth that
// began late looks like one that accelerates.
constexpr auto onsets = [] {
  std::array<std::pair<double, double>, 18> all{};
  for (std::size_t k = 0; k < all.size(); ++k) all[k] = {0.05 * static_cast<double>(k), k ? 4.0 / 17.0 : 4.0};
  return all;
}();
constexpr std::array<double, 9> noises = {0.1, 0.18, 0.32, 0.56, 1, 1.8, 3.2, 5.6, 10};
constexpr double negligible = 1e-4;  // weight below which a component is left out

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

// Gaussian linear regression with a Gaussian prior: evidence and posterior.
struct Regression {
  double log_evidence = 0;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
};
Regression regress(const Eigen::MatrixXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& variance,
                   const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_sd) {
  const Eigen::VectorXd weight = variance.cwiseInverse(), precision = prior_sd.cwiseAbs2().cwiseInverse();
  const Eigen::VectorXd r = y - x * prior_mean;
  Eigen::MatrixXd a = x.transpose() * weight.asDiagonal() * x;
  a.diagonal() += precision;
  const Eigen::VectorXd b = x.transpose() * weight.cwiseProduct(r);
  const Eigen::LLT<Eigen::MatrixXd> factor(a);
  const Eigen::VectorXd shift = factor.solve(b);
  Regression out;
  out.mean = prior_mean + shift;
  out.covariance = factor.solve(Eigen::MatrixXd::Identity(a.rows(), a.cols()));
  const double log_det = 2 * factor.matrixLLT().diagonal().array().log().sum();
  out.log_evidence = -0.5 * (weight.cwiseProduct(r).dot(r) - b.dot(shift) + variance.array().log().sum() + log_det -
                             precision.array().log().sum());
  return out;
}

double log_sum(const std::vector<double>& x) {
  const double top = *std::max_element(x.begin(), x.end());
  double sum = 0;
  for (double v : x) sum += std::exp(v - top);
  return top + std::log(sum);
}

}  // namespace

struct GrowthModel::Component {
  double weight = 0;
  Law law;
  double onset = 0, span = 1;  // [h]
  int direction = 0;
  double noise = 0;
  Eigen::VectorXd mean;  // base, features, growth
  Eigen::MatrixXd covariance;
};
GrowthModel::~GrowthModel() = default;
GrowthModel::GrowthModel(GrowthModel&&) noexcept = default;
GrowthModel& GrowthModel::operator=(GrowthModel&&) noexcept = default;

double quantile(const Life& life, double p) {
  const double at = p * static_cast<double>(life.size()) - 0.5;
  const auto last = static_cast<double>(life.size()) - 1;
  const double low = std::floor(std::clamp(at, 0.0, last));
  const double high = std::min(low + 1, last);
  const double a = life[static_cast<std::size_t>(low)], b = life[static_cast<std::size_t>(high)];
  const double part = std::clamp(at, 0.0, last) - low;
  return part == 0 ? a : a + part * (b - a);
}

GrowthModel::GrowthModel(std::vector<GrowthPoint> points, const GrowthPrior& prior) {
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  const auto n = static_cast<long>(points.size());
  const auto f = static_cast<long>(prior.feature_mean.size());
  const double first = points.front().time;
  now_ = points.back().time;
  Eigen::MatrixXd x(n, f + 2);
  Eigen::VectorXd y(n), own(n), mean(f + 2), sd(f + 2);
  mean[0] = prior.base, sd[0] = prior.base_sd;
  for (long j = 0; j < f; ++j)
    mean[j + 1] = prior.feature_mean[static_cast<std::size_t>(j)],
             sd[j + 1] = prior.feature_sd[static_cast<std::size_t>(j)];
  mean[f + 1] = 0, sd[f + 1] = prior.scale;
  for (long i = 0; i < n; ++i) {
    const GrowthPoint& p = points[static_cast<std::size_t>(i)];
    y[i] = p.y, own[i] = p.variance, x(i, 0) = 1;
    for (long j = 0; j < f; ++j) x(i, j + 1) = p.features[static_cast<std::size_t>(j)];
  }

  std::vector<double> null, all;
  Regression best_null;
  double best_null_noise = 0;
  std::vector<Component> found;
  for (double level : noises) {
    const double c = level * prior.noise;
    const Eigen::VectorXd variance = own.array() + c * c;
    const Regression none = regress(x.leftCols(f + 1), y, variance, mean.head(f + 1), sd.head(f + 1));
    if (null.empty() || none.log_evidence > *std::max_element(null.begin(), null.end()))
      best_null = none, best_null_noise = c;
    null.push_back(none.log_evidence - std::log(static_cast<double>(noises.size())));
    double laws_weight = 0, onsets_weight = 0;
    for (const Law& law : laws) laws_weight += law.weight;
    for (const auto& onset : onsets) onsets_weight += onset.second;
    for (const auto& [part, onset_weight] : onsets) {
      const double t0 = first + part * (now_ - first), span = std::max(now_ - t0, 1e-12);
      for (const Law& law : laws) {
        for (long i = 0; i < n; ++i) x(i, f + 1) = law.at((points[static_cast<std::size_t>(i)].time - t0) / span);
        Regression r = regress(x, y, variance, mean, sd);
        double evidence = r.log_evidence + std::log(law.weight / laws_weight * onset_weight / onsets_weight /
                                                    static_cast<double>(noises.size()));
        // A prior cut to one side: twice the part of the posterior that lies there.
        if (prior.direction != 0)
          evidence += std::log(std::max(
              1e-300, 2 * normal_cdf(prior.direction * r.mean[f + 1] / std::sqrt(r.covariance(f + 1, f + 1)))));
        all.push_back(evidence);
        found.push_back({evidence, law, t0, span, prior.direction, c, std::move(r.mean), std::move(r.covariance)});
      }
    }
  }
  const double growth = log_sum(all);
  growth_.log_bayes_factor = growth - log_sum(null);
  growth_.probability = 1 / (1 + std::exp(-growth_.log_bayes_factor));
  for (Component& c : found) {
    c.weight = std::exp(c.weight - growth);
    if (c.weight > negligible) components_.push_back(std::move(c));
  }
  // Means over growth laws; without a trend, of the null.
  double total = 0, square = 0;
  growth_.coefficients.assign(static_cast<std::size_t>(f), 0.0);
  for (const Component& c : components_) {
    const double at = c.mean[0] + c.mean[f + 1];
    total += c.weight;
    growth_.now += c.weight * at;
    square += c.weight * (at * at + c.covariance(0, 0) + c.covariance(f + 1, f + 1) + 2 * c.covariance(0, f + 1));
    growth_.base += c.weight * c.mean[0];
    growth_.slope += c.weight * c.mean[f + 1] * c.law.slope_at_1() / c.span;
    growth_.noise += c.weight * c.noise;
    for (long j = 0; j < f; ++j) growth_.coefficients[static_cast<std::size_t>(j)] += c.weight * c.mean[j + 1];
  }
  growth_.now /= total, growth_.base /= total, growth_.slope /= total, growth_.noise /= total;
  for (double& b : growth_.coefficients) b /= total;
  growth_.now_sd = std::sqrt(std::max(0.0, square / total - growth_.now * growth_.now));
  growth_.base_sd = std::sqrt(best_null.covariance(0, 0));
  growth_.null_noise = best_null_noise;
  if (growth_.probability < 0.5) {
    growth_.base = growth_.now = best_null.mean[0];
    growth_.now_sd = growth_.base_sd;
    growth_.noise = best_null_noise;
    for (long j = 0; j < f; ++j) growth_.coefficients[static_cast<std::size_t>(j)] = best_null.mean[j + 1];
  }
}

Life GrowthModel::life(std::optional<double> upper, std::optional<double> lower, std::uint64_t seed) const {
  constexpr int draws = 64, kept = 200;
  std::vector<std::pair<double, double>> passed;  // hours, weight
  for (std::size_t k = 0; k < components_.size(); ++k) {
    const Component& c = components_[k];
    const long last = c.mean.size() - 1;
    Random random(seed, 21, static_cast<std::uint32_t>(k));
    const double sd = std::sqrt(c.covariance(last, last));
    const double tilt = c.covariance(0, last) / c.covariance(last, last);
    const double rest = std::sqrt(std::max(0.0, c.covariance(0, 0) - tilt * c.covariance(0, last)));
    std::vector<double> hours;
    for (int i = 0; i < 20 * draws && hours.size() < draws; ++i) {
      const double a = c.mean[last] + sd * random.normal();
      const double base = c.mean[0] + tilt * (a - c.mean[last]) + rest * random.normal();
      if (c.direction != 0 && a * c.direction <= 0) continue;
      const std::optional<double>& level = a > 0 ? upper : lower;
      double t = std::numeric_limits<double>::infinity();
      if (level && a != 0) {
        const double g = (*level - base) / a;
        t = g <= 0 ? 0.0 : std::max(0.0, c.onset + c.span * c.law.inverse(g) - now_);
      }
      hours.push_back(t);
    }
    for (double t : hours) passed.emplace_back(t, c.weight / static_cast<double>(hours.size()));
  }
  std::sort(passed.begin(), passed.end());
  double total = 0;
  for (const auto& p : passed) total += p.second;
  Life life;
  double sum = 0;
  std::size_t i = 0;
  for (int q = 0; q < kept && !passed.empty(); ++q) {
    const double target = (q + 0.5) / kept * total;
    while (i + 1 < passed.size() && sum + passed[i].second < target) sum += passed[i].second, ++i;
    life.push_back(passed[i].first);
  }
  return life;
}

}  // namespace servodx
