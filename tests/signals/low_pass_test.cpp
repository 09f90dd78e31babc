// The rig's analogue low-pass: what it does to a sine, a constant and a step, whatever the stamps.
#include "signals/low_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

// Even stamps, or such that jitter by a third of their distance.
std::vector<double> stamps(std::size_t n, double h, bool jitter) {
  Random random(5);
  std::vector<double> t;
  for (std::size_t k = 0; k < n; ++k)
    t.push_back(h * (static_cast<double>(k) + (jitter ? 0.3 * (random.uniform() - 0.5) : 0)));
  return t;
}

// Of the second half of a sine of `f`, by least squares.
std::complex<double> through(int order, double cutoff, double f, bool jitter) {
  const std::vector<double> t = stamps(20000, 5e-5, jitter);
  std::vector<double> x;
  for (const double s : t) x.push_back(std::sin(two_pi * f * s));
  std::vector<double> y = x;
  LowPass(t, cutoff, order)(y);
  double ss = 0, cc = 0, sc = 0, ys = 0, yc = 0;
  for (std::size_t k = t.size() / 2; k < t.size(); ++k) {
    const double s = std::sin(two_pi * f * t[k]), c = std::cos(two_pi * f * t[k]);
    ss += s * s, cc += c * c, sc += s * c, ys += y[k] * s, yc += y[k] * c;
  }
  const double det = ss * cc - sc * sc;
  return {(ys * cc - yc * sc) / det, (yc * ss - ys * sc) / det};
}

TEST(LowPass, IsButterworthsInGainAndPhase) {
  for (const bool jitter : {false, true})
    for (const int order : {1, 2, 3, 4, 8})
      for (const double f : {20.0, 100.0, 200.0}) {
        const std::complex<double> s(0, f / 100);
        std::complex<double> expected = 1;
        for (int k = 0; k < order; ++k) {
          const auto pole = std::polar(1.0, std::numbers::pi * (0.5 + (k + 0.5) / order));
          expected *= -pole / (s - pole);
        }
        EXPECT_LT(std::abs(through(order, 100, f, jitter) - expected), 2e-3) << order << " at " << f << jitter;
      }
}

TEST(LowPass, AConstantStaysAndAStepEndsAtItsLevel) {
  const std::vector<double> t = stamps(400, 1e-3, true);
  std::vector<double> constant(t.size(), 3.0), step(t.size(), 0.0);
  for (std::size_t k = 100; k < step.size(); ++k) step[k] = 1;
  for (const int order : {1, 2, 4}) {
    std::vector<double> x = constant, y = step;
    LowPass(t, 50, order)(x);
    LowPass(t, 50, order)(y);
    for (const double v : x) EXPECT_NEAR(v, 3.0, 1e-12);
    EXPECT_EQ(y[99], 0.0);
    EXPECT_NEAR(y.back(), 1.0, 1e-9);
  }
}

TEST(LowPass, RefusesWhatIsNoFilter) {
  const std::vector<double> t = stamps(4, 1e-3, false);
  EXPECT_THROW(LowPass(t, 0, 2), std::invalid_argument);
  EXPECT_THROW(LowPass(t, 10, 0), std::invalid_argument);
  EXPECT_THROW(LowPass(t, 10, 9), std::invalid_argument);
}

}  // namespace
}  // namespace servodx
