#include "evidence/excess_trend.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "evidence/constants.h"

namespace servodx {
using namespace evidence_constants;

namespace {

// Of exponential excesses with a mean in proportion to exp(slope d), d about a mean of nought: minus the logarithm of
// the likelihood at its best mean and of the slope's normal prior, but for a constant; and its derivative by the slope.
struct Profile {
  double minus_log = 0, derivative = 0;
};

Profile profile(const std::vector<ExcessAt>& about_middle, double slope) {
  const auto n = static_cast<double>(about_middle.size());
  const double off = slope / usual_trend;
  double sum = 0, moment = 0;
  for (const auto& [excess, d] : about_middle) {
    const double e = excess * std::exp(-slope * d);
    sum += e, moment += d * e;
  }
  return {n * std::log(sum) + 0.5 * off * off, -n * moment / sum + off / usual_trend};
}

// The profile is convex: its derivative passes zero once.
double likeliest_slope(const std::vector<ExcessAt>& about_middle) {
  double low = -steepest_trend, high = steepest_trend;
  for (int step = 0; step < trend_halvings; ++step) {
    const double slope = 0.5 * (low + high);
    (profile(about_middle, slope).derivative < 0 ? low : high) = slope;
  }
  return 0.5 * (low + high);
}

}  // namespace

ExcessTrend::ExcessTrend(const std::vector<ExcessAt>& healthy) {
  const auto n = static_cast<double>(healthy.size());
  if (healthy.size() < fewest_for_a_trend) return;
  for (const ExcessAt& e : healthy) middle_ += e.at / n;
  if (!std::isfinite(middle_)) return;
  std::vector<ExcessAt> about_middle;
  for (const ExcessAt& e : healthy) about_middle.push_back({std::max(e.excess, little_excess), e.at - middle_});
  const double slope = likeliest_slope(about_middle);
  if (2 * (profile(about_middle, 0).minus_log - profile(about_middle, slope).minus_log) <= std::log(n)) return;
  const auto [least, most] = std::minmax_element(healthy.begin(), healthy.end(),
                                                 [](const ExcessAt& a, const ExcessAt& b) { return a.at < b.at; });
  slope_ = slope, least_ = least->at, most_ = most->at, mean_ = 0;
  for (const ExcessAt& e : about_middle) mean_ += std::exp(slope * e.at) / n;
}

double ExcessTrend::scale(double at) const {
  if (slope_ == 0 || !std::isfinite(at)) return 1;
  return std::exp(slope_ * (std::clamp(at, least_, most_) - middle_)) / mean_;
}

}  // namespace servodx
