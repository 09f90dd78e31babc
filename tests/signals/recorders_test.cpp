// Two recorders of one test: offset and skew of the second's clock are found within what is stated.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "servodx/error.h"
#include "servodx/join.h"
#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {
namespace {

// A random, smooth motion and its pressure at any time.
struct Truth {
  std::vector<double> f, a, phase;
  explicit Truth(std::uint64_t seed) {
    Random random(seed);
    for (int k = 0; k < 60; ++k) {
      f.push_back(random.uniform(0.05, 12));
      a.push_back(random.normal());
      phase.push_back(random.uniform(0, 6.28));
    }
  }
  double operator()(double t) const {
    double x = 0;
    for (std::size_t k = 0; k < f.size(); ++k) x += a[k] * std::sin(6.283185307 * f[k] * t + phase[k]);
    return x;
  }
};

struct Recorder {
  double offset, skew;  // of its clock: true time = offset + (1 + skew) t
  double begin, end, rate;
  std::uint64_t seed;
};

Log record(const Truth& truth, const Recorder& r, std::initializer_list<Signal> signals) {
  Log log;
  log.path = "recorder";
  Random random(r.seed, 1);
  for (double t = r.begin; t < r.end; t += (1 + 0.02 * random.normal()) / r.rate) log.time.push_back(t);
  for (Signal s : signals) {
    Channel& c = log.channels[index(s)];
    c.unit = info(s).si_unit;
    const double gain = 1 + index(s), bias = 3.0 * static_cast<double>(r.seed);
    for (double t : log.time)
      c.value.push_back(bias + gain * truth(r.offset + (1 + r.skew) * t + 0.01 * index(s)) + 0.02 * random.normal());
  }
  return log;
}

TEST(Recorders, OffsetAndSkewAreFoundWithinTheStatedErrors) {
  int inside = 0, all = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Truth truth(seed);
    Random random(seed, 7);
    const double offset = random.uniform(-20, 20) + (seed % 2 ? 1.7e5 : 0), skew = random.uniform(-4e-4, 4e-4);
    const Log first = record(truth, {0, 0, 0, 60, 1000, 11}, {Signal::spool_position, Signal::command});
    const double begin = (10 - offset) / (1 + skew);
    const Log second =
        record(truth, {offset, skew, begin, begin + 55, 400, 12}, {Signal::spool_position, Signal::pressure_a});
    ClockFit clock;
    const Log joined = join_recorders(first, second, {}, clock);
    // The offset belongs to the middle of the overlap, far from the clock's zero where the skew's error would tell.
    const double middle = begin + 25;
    const double error = (clock.offset + (1 + clock.skew) * middle) - (offset + (1 + skew) * middle);
    EXPECT_LT(std::abs(error), 1e-4) << seed;
    EXPECT_LT(std::abs(clock.skew - skew), 1e-5) << seed;
    inside += std::abs(error) < 2 * clock.offset_error;
    inside += std::abs(clock.skew - skew) < 2 * clock.skew_error;
    all += 2;
    ASSERT_TRUE(joined.has(Signal::pressure_a));
    EXPECT_GE(joined.time.front(), 9.99);
    double worst = 0;
    for (std::size_t k = 0; k < joined.samples(); ++k)
      worst = std::max(
          worst, std::abs(joined[Signal::pressure_a][k] - 36.0 -
                          (1 + index(Signal::pressure_a)) * truth(joined.time[k] + 0.01 * index(Signal::pressure_a))));
    EXPECT_LT(worst, 0.5) << "of a range of hundreds";
  }
  EXPECT_GE(inside, all * 3 / 4);
}

TEST(Recorders, WhatDoesNotSettleTheClockIsRefused) {
  const auto refusal = [](const Log& first, const Log& second, const JoinOptions& options) -> std::string {
    ClockFit clock;
    try {
      join_recorders(first, second, options, clock);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  const Truth truth(3), other(4);
  const Log first = record(truth, {0, 0, 0, 30, 500, 1}, {Signal::command, Signal::spool_position});
  EXPECT_EQ(refusal(first, record(truth, {0, 0, 0, 30, 500, 2}, {Signal::pressure_a}), {}),
            "recorder: shares no signal with recorder; record one signal on both, such as the command, and map it in "
            "[columns] of the rig file");
  EXPECT_EQ(refusal(first, record(truth, {0, 0, 0, 30, 500, 2}, {Signal::command}), {.by = Signal::spool_position}),
            "recorder: 'spool_position' is not in both logs; name with --by a signal that both recorded");
  EXPECT_NE(refusal(first, record(other, {0, 0, 0, 30, 500, 2}, {Signal::command}), {}).find("are not alike"),
            std::string::npos);
  Truth sine(5);
  sine.f = {2.0}, sine.a = {1.0}, sine.phase = {0.0};
  const Log once = record(sine, {0, 0, 0, 30, 500, 1}, {Signal::command});
  const Log twice = record(sine, {1.0, 0, 0, 25, 500, 2}, {Signal::command, Signal::spool_position});
  EXPECT_NE(refusal(once, twice, {}).find("'command' repeats itself"), std::string::npos);
  ClockFit clock;
  join_recorders(once, twice, {.near = 1.05, .near_within = 0.2}, clock);
  EXPECT_NEAR(clock.offset, 1.0, 1e-3);
}

}  // namespace
}  // namespace servodx
