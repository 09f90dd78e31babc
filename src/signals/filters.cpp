#include "signals/filters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace servodx {
namespace {

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

// Weighted sums over one side of the window for the basis {1, cos, sin}.
struct Sums {
  double w = 0, c = 0, s = 0, cc = 0, cs = 0, ss = 0;  // normal matrix
  double x = 0, xc = 0, xs = 0;                        // right-hand side

  void decay(double factor) {
    for (double* sum : {&w, &c, &s, &cc, &cs, &ss, &x, &xc, &xs}) *sum *= factor;
  }
  void add(double cosine, double sine, double value) {
    if (std::isnan(value)) return;
    w += 1;
    c += cosine;
    s += sine;
    cc += cosine * cosine;
    cs += cosine * sine;
    ss += sine * sine;
    x += value;
    xc += value * cosine;
    xs += value * sine;
  }
};

Sums operator+(Sums a, const Sums& b) {
  a.w += b.w, a.c += b.c, a.s += b.s, a.cc += b.cc, a.cs += b.cs, a.ss += b.ss;
  a.x += b.x, a.xc += b.xc, a.xs += b.xs;
  return a;
}

// The fitted sinusoid at (cosine, sine), the constant eliminated first.
double sinusoid(const Sums& n, double cosine, double sine) {
  if (!(n.w > 0.0)) return 0.0;
  const double ridge = 1e-12 * n.w;  // a direction that the stamps do not show stays at zero
  const double cc = n.cc - n.c * n.c / n.w + ridge;
  const double cs = n.cs - n.c * n.s / n.w;
  const double ss = n.ss - n.s * n.s / n.w + ridge;
  const double xc = n.xc - n.x * n.c / n.w;
  const double xs = n.xs - n.x * n.s / n.w;
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 0.0)) return 0.0;
  return ((ss * xc - cs * xs) * cosine + (cc * xs - cs * xc) * sine) / determinant;
}

}  // namespace

std::vector<double> moving_average(std::span<const double> x, int window) {
  if (window < 1 || window % 2 == 0) throw std::invalid_argument("moving_average: the window must be odd and positive");
  const auto n = static_cast<std::ptrdiff_t>(x.size());
  std::vector<double> y(x.size());
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    if (std::isnan(x[i])) {
      y[i] = missing_value;
      continue;
    }
    const std::ptrdiff_t half = std::min({std::ptrdiff_t{window / 2}, i, n - 1 - i});
    double sum = 0.0;
    int count = 0;
    for (std::ptrdiff_t j = i - half; j <= i + half; ++j) {
      if (std::isnan(x[j])) continue;
      sum += x[j] - x[i];  // about the centre: a constant passes bit for bit
      ++count;
    }
    y[i] = x[i] + sum / count;
  }
  return y;
}

std::vector<double> notch(std::span<const double> time, std::span<const double> x, double frequency,
                          double half_width) {
  if (time.size() != x.size()) throw std::invalid_argument("notch: time and signal differ in length");
  if (!(frequency > 0.0) || !(half_width > 0.0))
    throw std::invalid_argument("notch: frequency and half_width must be positive");
  const double rate = 2.0 * std::numbers::pi * half_width;
  const std::size_t n = x.size();
  // About its first sample, where cancellation is least; the fit's constant takes any offset.
  const auto first = std::find_if(x.begin(), x.end(), [](double v) { return !std::isnan(v); });
  const double origin = first == x.end() ? 0.0 : *first;
  std::vector<double> cosine(n), sine(n);
  std::vector<Sums> after(n);  // samples k+1 .. n-1 seen from k
  for (std::size_t k = 0; k < n; ++k) {
    const double angle = 2.0 * std::numbers::pi * frequency * (time[k] - time[0]);
    cosine[k] = std::cos(angle);
    sine[k] = std::sin(angle);
  }
  for (std::size_t k = n; k-- > 1;) {
    Sums sums = after[k];
    sums.add(cosine[k], sine[k], x[k] - origin);
    sums.decay(std::exp(-rate * (time[k] - time[k - 1])));
    after[k - 1] = sums;
  }
  std::vector<double> y(n);
  Sums before;
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) before.decay(std::exp(-rate * (time[k] - time[k - 1])));
    before.add(cosine[k], sine[k], x[k] - origin);
    y[k] = x[k] - sinusoid(before + after[k], cosine[k], sine[k]);
  }
  return y;
}

std::vector<double> high_pass(std::span<const double> time, std::span<const double> x, double cutoff) {
  if (time.size() != x.size()) throw std::invalid_argument("high_pass: time and signal differ in length");
  std::vector<double> y(x.begin(), x.end());
  HighPass(time, x, cutoff)(y);
  return y;
}

HighPass::HighPass(std::span<const double> time, std::span<const double> like, double cutoff)
    : keep_(like.size()), gain_(like.size()), start_(like.size(), missing_value) {
  if (!(cutoff > 0.0)) throw std::invalid_argument("high_pass: the cutoff must be positive");
  const double rate = 2.0 * std::numbers::pi * cutoff;
  double decayed = 1.0, last_time = missing_value;
  for (std::size_t k = 0; k < like.size(); ++k) {
    if (std::isnan(like[k])) continue;
    if (!std::isnan(last_time)) {
      const double z = rate * (time[k] - last_time);
      // y' = x' - rate y, with x' constant between the stamps.
      keep_[k] = std::exp(-z);
      gain_[k] = -std::expm1(-z) / z;
      decayed *= keep_[k];
    }
    start_[k] = decayed;
    own_ += decayed * decayed;
    last_time = time[k];
  }
}

void HighPass::operator()(std::span<double> x) const {
  double state = 0.0, last = missing_value, along = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(start_[k])) {
      x[k] = missing_value;
      continue;
    }
    if (!std::isnan(last)) state = keep_[k] * state + (x[k] - last) * gain_[k];
    last = std::exchange(x[k], state);
    along += state * start_[k];
  }
  // Where the signal stood before its first sample is not known; what that leaves behind is taken out as a whole. From
  // one sample, or a few, their noise would stay for the whole of the filter's memory.
  if (!(own_ > 0.0)) return;
  for (std::size_t k = 0; k < x.size(); ++k) x[k] -= along / own_ * start_[k];
}

std::vector<double> Filter::operator()(std::span<const double> time, std::span<const double> x) const {
  std::vector<double> y(x.begin(), x.end());
  if (window != 1) y = moving_average(y, window);
  if (mains > 0.0) y = notch(time, y, mains, mains_half_width);
  if (drift > 0.0) y = high_pass(time, y, drift);
  return y;
}

}  // namespace servodx
