#include "evidence/conditions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/present.h"
#include "base/two_pi.h"
#include "evidence/constants.h"
#include "signals/drive_of.h"

namespace servodx {
namespace {

using namespace evidence_constants;

double variance(const std::vector<double>& x) {
  const double middle = mean_of_present(x);
  return mean_of_present(0, x.size(), [&](std::size_t k) { return (x[k] - middle) * (x[k] - middle); });
}

// Mean square of what a series changes by over so many samples.
double square_change(const std::vector<double>& x, std::size_t stride) {
  return mean_of_present(stride, x.size(),
                         [&](std::size_t k) { return (x[k] - x[k - stride]) * (x[k] - x[k - stride]); });
}

// How far a sine turns until its mean square change, 2 (1 - cos) of the variance, is that: at most pi. [rad]
double turn_at(double change_over_variance) { return std::acos(std::clamp(1 - 0.5 * change_over_variance, -1.0, 1.0)); }

// Frequency of the sine that decorrelates as fast as the series. Between two strides the turn goes in a line, which it
// does for a sine: so neither how the strides grow nor how few samples a period has matters.
double band_of(const std::vector<double>& t, const std::vector<double>& x) {
  const auto there = std::count_if(x.begin(), x.end(), [](double v) { return std::isfinite(v); });
  const double whole = variance(x);
  if (static_cast<std::size_t>(there) < fewest_of_drive || whole <= 0) return 0;
  const double sought = turn_at(decorrelated);
  double shorter = 0, turned = 0;  // [samples] [rad] of the stride before
  for (std::size_t stride = 1; stride < x.size() / 2; stride = std::max(stride + 1, stride * 5 / 4)) {
    const double change = square_change(x, stride);
    if (!std::isfinite(change)) continue;
    const double turn = turn_at(change / whole), longer = static_cast<double>(stride);
    if (turn >= sought) {
      const double samples = shorter + (longer - shorter) * (sought - turned) / (turn - turned);
      return sought / two_pi / (samples * (t.back() - t.front()) / static_cast<double>(t.size() - 1));
    }
    shorter = longer, turned = turn;
  }
  return 0;
}

// Of two positive numbers, in powers of `like`; of a drive that stands still against one that moves: far.
double ratio_distance(double a, double b, double like) {
  if (a == b) return 0;
  if (!(a > 0 && b > 0)) return HUGE_VAL;
  return std::abs(std::log(a / b)) / std::log(like);
}

bool same_programme(const TestConditions& a, const TestConditions& b) {
  if (!(a.drive_rms > 0 && b.drive_rms > 0)) return false;
  return ratio_distance(a.drive_span, b.drive_span, same_size) <= 1 &&
         ratio_distance(a.drive_rms, b.drive_rms, same_size) <= 1 &&
         ratio_distance(a.drive_band, b.drive_band, same_band) <= 1;
}

}  // namespace

TestConditions conditions_of(const Log& log) {
  TestConditions c;
  const std::vector<double>& drive = log[drive_of(log)];
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const double v : drive)
    if (std::isfinite(v)) lowest = std::min(lowest, v), highest = std::max(highest, v);
  c.drive_span = std::max(0.0, highest - lowest);
  c.drive_rms = std::sqrt(variance(drive));
  c.drive_band = band_of(log.time, drive);
  if (log.has(Signal::oil_temperature))
    if (const double t = mean_of_present(log[Signal::oil_temperature]); std::isfinite(t)) c.temperature = t;
  return c;
}

double distance(const TestConditions& a, const TestConditions& b) {
  double d = std::max(ratio_distance(a.drive_span, b.drive_span, like_span),
                      ratio_distance(a.drive_band, b.drive_band, like_band));
  if (a.temperature && b.temperature) d = std::max(d, std::abs(*a.temperature - *b.temperature) / like_temperature);
  return d;
}

Apart apart(const TestConditions& a, const TestConditions& b) {
  Apart out;
  out.span = ratio_distance(a.drive_span, b.drive_span, like_span) > 1;
  out.band = ratio_distance(a.drive_band, b.drive_band, like_band) > 1;
  if (!a.temperature || !b.temperature) return out;
  const double kelvin = std::abs(*a.temperature - *b.temperature);
  out.oil = kelvin > like_temperature ? kelvin : 0;
  return out;
}

bool is_repeat(const TestConditions& a, const TestConditions& b) { return same_programme(a, b) && distance(a, b) <= 1; }

std::vector<std::size_t> programmes_of(const std::vector<TestConditions>& logs) {
  std::vector<TestConditions> first;
  std::vector<std::size_t> out;
  for (const TestConditions& log : logs) {
    const auto known =
        std::find_if(first.begin(), first.end(), [&](const auto& one) { return same_programme(one, log); });
    out.push_back(static_cast<std::size_t>(known - first.begin()));
    if (known == first.end()) first.push_back(log);
  }
  return out;
}

bool show_scatter_of_tests(const std::vector<TestConditions>& logs) {
  const std::vector<std::size_t> of = programmes_of(logs);
  return !of.empty() && *std::max_element(of.begin(), of.end()) + 1 >= programmes_that_scatter;
}

}  // namespace servodx
