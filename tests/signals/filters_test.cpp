#include "signals/filters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/random.h"

namespace servodx {
namespace {

constexpr double two_pi = 2 * std::numbers::pi;

std::vector<double> even(int n, double dt) {
  std::vector<double> t;
  for (int i = 0; i < n; ++i) t.push_back(i * dt);
  return t;
}

// 1 kHz with 30 % jitter and a gap.
std::vector<double> uneven(int n) {
  Random random(2);
  std::vector<double> t;
  for (int i = 0; i < n; ++i) t.push_back(1e-3 * (i + random.uniform(-0.3, 0.3)) + (i > n / 2 ? 0.0373 : 0.0));
  return t;
}

std::vector<double> sine(const std::vector<double>& t, double f, double amplitude = 1.0, double phase = 0.4) {
  std::vector<double> x;
  for (double each : t) x.push_back(amplitude * std::sin(two_pi * f * each + phase));
  return x;
}

// Largest value away from the ends.
double middle_peak(const std::vector<double>& x, std::size_t margin) {
  double peak = 0;
  for (std::size_t i = margin; i + margin < x.size(); ++i) peak = std::max(peak, std::abs(x[i]));
  return peak;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b, std::size_t margin = 0) {
  double peak = 0;
  for (std::size_t i = margin; i + margin < a.size(); ++i)
    if (!std::isnan(a[i])) peak = std::max(peak, std::abs(a[i] - b[i]));
  return peak;
}

const Filter chains[] = {{.window = 5},
                         {.mains = 50},
                         {.mains = 60, .mains_half_width = 3},
                         {.drift = 0.3},
                         {.window = 3, .mains = 50, .drift = 0.3}};

TEST(Filters, AConstantPasses) {
  for (const auto& t : {even(2000, 1e-3), uneven(2000)}) {
    std::vector<double> x(t.size(), 207e5);
    x[700] = NAN;
    const auto averaged = moving_average(x, 7);
    const auto notched = notch(t, x, 50, 1);
    const auto passed = high_pass(t, x, 0.3);
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (std::isnan(x[i])) continue;
      ASSERT_EQ(averaged[i], x[i]);
      ASSERT_EQ(notched[i], x[i]);
      ASSERT_EQ(passed[i], 0.0);
    }
  }
}

// What a filter does to the residual is what it does to measurement and simulation alike.
TEST(Filters, TheDifferenceOfTheFilteredIsTheFilteredDifference) {
  Random random(8);
  for (const auto& t : {even(3000, 1e-3), uneven(3000)}) {
    std::vector<double> measured = sine(t, 3.0, 2.0), simulated = sine(t, 3.1, 2.0), difference;
    for (std::size_t i = 0; i < t.size(); ++i) {
      measured[i] += 0.3 * std::sin(two_pi * 50 * t[i]) + random.normal();
      if (i % 71 == 3) measured[i] = simulated[i] = NAN;
    }
    for (std::size_t i = 0; i < t.size(); ++i) difference.push_back(measured[i] - simulated[i]);
    for (const Filter& filter : chains) {
      const auto a = filter(t, measured), b = filter(t, simulated), c = filter(t, difference);
      for (std::size_t i = 0; i < t.size(); ++i) {
        ASSERT_EQ(std::isnan(c[i]), std::isnan(measured[i]));
        if (!std::isnan(c[i])) {
          ASSERT_NEAR(a[i] - b[i], c[i], 1e-10);
        }
      }
    }
  }
}

TEST(Notch, RemovesTheMainsLineOnAnyStamps) {
  for (const auto& t : {even(3000, 1e-3), uneven(3000)}) {
    for (double f : {50.0, 60.0}) {
      std::vector<double> x = sine(t, f);
      for (double& v : x) v += 207.0;
      x[100] = x[1500] = NAN;
      const auto y = notch(t, x, f, 1.0);
      for (std::size_t i = 0; i < t.size(); ++i) {
        if (!std::isnan(x[i])) {
          ASSERT_NEAR(y[i], 207.0, 1e-8);
        }
      }
    }
  }
}

TEST(Notch, HasTheStatedGain) {
  const auto t = even(8000, 1e-3);
  for (double f : {2.0, 10.0, 39.0, 48.0, 49.0, 50.5, 53.0, 61.0, 100.0, 200.0, 400.0}) {
    const auto x = sine(t, f);
    const double d = (f - 50.0) / 1.0;
    const double gain = middle_peak(notch(t, x, 50, 1.0), 2000);
    EXPECT_NEAR(gain, d * d / (1 + d * d), 0.005) << f;
    if (std::abs(d) >= 10) {
      EXPECT_GT(gain, 0.99) << f;
    }
  }
}

TEST(Notch, ShiftsNoPhase) {
  const auto t = even(8000, 1e-3);
  for (double f : {5.0, 40.0, 120.0}) {
    const auto x = sine(t, f);
    EXPECT_LT(largest_difference(x, notch(t, x, 50, 1.0), 2000), 0.015) << f;
  }
}

TEST(MovingAverage, HasTheGainOfItsWindow) {
  const auto t = even(4000, 1e-3);
  for (double f : {5.0, 50.0, 130.0}) {
    const double expected =
        std::abs(std::sin(std::numbers::pi * f * 9e-3) / (9 * std::sin(std::numbers::pi * f * 1e-3)));
    const auto x = sine(t, f);
    std::vector<double> scaled;
    const double sign = std::sin(std::numbers::pi * f * 9e-3) < 0 ? -1 : 1;
    for (double v : x) scaled.push_back(sign * expected * v);
    EXPECT_LT(largest_difference(moving_average(x, 9), scaled, 10), 1e-9) << f;
  }
}

TEST(MovingAverage, ARampPassesEndsIncluded) {
  std::vector<double> x;
  for (int i = 0; i < 50; ++i) x.push_back(0.25 * i);
  EXPECT_LT(largest_difference(moving_average(x, 9), x), 1e-12);
}

TEST(MovingAverage, AWindowIsOddAndPositive) {
  EXPECT_THROW(moving_average(std::vector<double>(9), 4), std::invalid_argument);
  EXPECT_THROW(moving_average(std::vector<double>(9), 0), std::invalid_argument);
  EXPECT_THROW(moving_average(std::vector<double>(9), -3), std::invalid_argument);
}

// A ramp of slope m gives m tau (1 - exp(-t / tau)), whatever the stamps.
TEST(HighPass, IsExactForARampOnAnyStamps) {
  for (const auto& t : {even(3000, 1e-3), uneven(3000)}) {
    std::vector<double> x;
    for (double each : t) x.push_back(2.0 * each + 5);
    x[400] = NAN;
    const double tau = 1 / (two_pi * 0.3);
    const auto y = high_pass(t, x, 0.3);
    // The steady lag, and a start that dies away.
    const double start = y[0] - 2.0 * tau;
    double along = 0;
    for (std::size_t i = 0; i < t.size(); ++i) {
      if (!std::isnan(x[i])) {
        const double decayed = std::exp(-(t[i] - t[0]) / tau);
        ASSERT_NEAR(y[i], 2.0 * tau + start * decayed, 1e-11);
        along += y[i] * decayed;
      }
    }
    EXPECT_NEAR(along, 0.0, 1e-8);  // no other start leaves less
  }
}

TEST(HighPass, HasTheFirstOrderGain) {
  const auto t = even(20000, 1e-3);
  for (double f : {0.1, 0.3, 3.0, 30.0}) {
    const double gain = middle_peak(high_pass(t, sine(t, f), 0.3), 5000);
    EXPECT_NEAR(gain, f / std::hypot(f, 0.3), 0.005) << f;
  }
}

TEST(Filters, WhatIsOffChangesNothing) {
  const auto t = uneven(100);
  const auto x = sine(t, 20);
  EXPECT_EQ(Filter{}(t, x), x);
}

TEST(Filters, ShortAndEmptyRecordsAreTaken) {
  for (const Filter& filter : chains)
    for (int n : {0, 1, 2, 3}) EXPECT_EQ(filter(even(n, 1e-3), std::vector<double>(n, 1.0)).size(), n);
}

// What the first samples say of the start must not last for the filter's memory: white noise stays nearly white, and
// the part of it that dies away as the memory does is not there at all.
TEST(Filters, HighPassLeavesNoTraceOfTheNoiseOfItsFirstSamples) {
  const auto t = even(4000, 1e-3);
  for (unsigned seed = 0; seed < 20; ++seed) {
    Random random(23, seed);
    std::vector<double> x(t.size());
    for (double& v : x) v = random.normal();
    const auto y = high_pass(t, x, 0.3);
    double along = 0, own = 0;
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double decayed = std::exp(-two_pi * 0.3 * t[k]);
      along += y[k] * decayed, own += decayed * decayed;
    }
    EXPECT_LT(std::abs(along / std::sqrt(own)), 1e-6);  // a start of one sample's noise would leave some 16
  }
}

}  // namespace
}  // namespace servodx
