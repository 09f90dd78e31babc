#include "evidence/conditions.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "evidence/constants.h"

namespace servodx {
namespace {

using namespace evidence_constants;

// Frequency of the sine that decorrelates as fast as the series: found as the stride at which the mean square
// difference reaches `decorrelated` of the variance; its end value is twice the variance.
double band_of(const std::vector<double>& t, const std::vector<double>& x) {
  double mean = 0, square = 0;
  std::size_t n = 0;
  for (const double v : x)
    if (std::isfinite(v)) mean += v, ++n;
  if (n < fewest_of_drive) return 0;
  mean /= static_cast<double>(n);
  for (const double v : x)
    if (std::isfinite(v)) square += (v - mean) * (v - mean);
  square /= static_cast<double>(n);
  if (square <= 0) return 0;
  for (std::size_t stride = 1; stride < x.size() / 2; stride = std::max(stride + 1, stride * 5 / 4)) {
    double difference = 0;
    std::size_t pairs = 0;
    for (std::size_t k = stride; k < x.size(); ++k)
      if (std::isfinite(x[k]) && std::isfinite(x[k - stride]))
        difference += (x[k] - x[k - stride]) * (x[k] - x[k - stride]), ++pairs;
    if (pairs > 0 && difference / static_cast<double>(pairs) >= decorrelated * square)
      return decorrelated_after /
             (static_cast<double>(stride) * (t.back() - t.front()) / static_cast<double>(t.size() - 1));
  }
  return 0;
}

double mean(const std::vector<double>& x) {
  double sum = 0;
  std::size_t n = 0;
  for (const double v : x)
    if (std::isfinite(v)) sum += v, ++n;
  return n > 0 ? sum / static_cast<double>(n) : std::nan("");
}

double deviation(const std::vector<double>& x) {
  const double middle = mean(x);
  std::vector<double> square;
  for (const double v : x) square.push_back((v - middle) * (v - middle));
  return std::sqrt(mean(square));
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
  const std::vector<double>& drive = log[log.has(Signal::coil_current) ? Signal::coil_current : Signal::command];
  double lowest = HUGE_VAL, highest = -HUGE_VAL;
  for (const double v : drive)
    if (std::isfinite(v)) lowest = std::min(lowest, v), highest = std::max(highest, v);
  c.drive_span = std::max(0.0, highest - lowest);
  c.drive_rms = deviation(drive);
  c.drive_band = band_of(log.time, drive);
  if (log.has(Signal::oil_temperature))
    if (const double t = mean(log[Signal::oil_temperature]); std::isfinite(t)) c.temperature = t;
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
