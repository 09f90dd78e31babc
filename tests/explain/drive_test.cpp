// What a driver does is told between the command and the coil current, without a valve.
#include "explain/drive.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "base/random.h"
#include "explain/beside_healthy.h"
#include "explain/cause_score.h"
#include "explain/cause_sizes.h"
#include "explain/engine.h"
#include "explain/fit_causes.h"
#include "explain/healthy.h"
#include "explain/score.h"
#include "explain/valve.h"
#include "servodx/log.h"

namespace servodx {
namespace {

constexpr double pi = std::numbers::pi;

double asked(double t) { return 0.004 * std::sin(2 * pi * 3 * t) + 0.002 * std::sin(2 * pi * 17 * t + 1) + 0.001; }

// A driver by other equations: the command is held from sample to sample and passes a lag in small steps.
Log log_of_driver(double delay, double lag, double gain, std::uint64_t seed) {
  constexpr int n = 3000, fine = 50;
  constexpr double step = 1e-3;
  Log log;
  Random random(seed);
  std::vector<double>&command = log.channels[index(Signal::command)].value,
  &current = log.channels[index(Signal::coil_current)].value;
  double felt = asked(0);
  for (int k = 0; k < n; ++k) {
    log.time.push_back(k * step);
    command.push_back(asked(k * step));
    current.push_back(gain * felt + 2e-5 + 5e-6 * random.normal());
    for (int i = 0; i < fine; ++i) {
      const double past = (k + (i + 0.5) / fine) * step - delay, held = std::floor(past / step) * step;
      felt += (asked(std::max(0.0, held)) - felt) * (lag > 0 ? 1 - std::exp(-step / fine / lag) : 1.0);
    }
  }
  return log;
}

Log healthy_log(std::uint64_t seed) {
  return log_of_driver(2e-4 * static_cast<double>(seed % 3), 3e-4, 1.0 + 0.002 * static_cast<double>(seed), seed);
}

struct Told {
  std::string name;
  double value = 0;
};
// The first cause beyond what `healthy` logs show; none: nothing is.
std::optional<Told> told_of(const Log& log, const HealthyReference* healthy = nullptr) {
  DriveSubject drive({log}, healthy ? healthy->known() : KnownRig{});
  EngineOptions options;
  std::optional<HealthyTest> test;
  if (healthy) {
    test.emplace(*healthy);
    options.level = 0.01;
    options.p_new = [&](const CauseScore& s, int) { return test->together(test->alone({summarise(drive, s)})); };
  }
  const FoundCauses found = explain(drive, options);
  if (found.causes.empty()) return {};
  const CauseResult& first = found.causes.front();
  return Told{drive.causes()[static_cast<std::size_t>(first.cause)].effect, first.value.front()};
}

HealthyReference healthy_drivers() {
  HealthyReference out;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    HealthyLog& h = out.logs.emplace_back();
    const UsualDrive usual = *usual_drive(healthy_log(seed));
    h.drive_delay = usual.delay, h.errors = {usual.error};
  }
  for (int i = 0; i < 8; ++i)
    out.logs[static_cast<std::size_t>(i)].scores =
        score_drive(healthy_log(static_cast<std::uint64_t>(i) + 1), out.known(i));
  return out;
}

TEST(Drive, ASineLagsByItsDelayAndItsLag) {
  constexpr double frequency = 20, delay = 2.3e-3, lag = 4e-3;
  std::vector<double> time, command;
  for (int k = 0; k < 4000; ++k)
    time.push_back(k * 2.5e-4), command.push_back(std::sin(2 * pi * frequency * time.back()));
  const std::vector<double> felt = through_driver(time, command, delay, lag);
  const double w = 2 * pi * frequency, size = 1 / std::hypot(1, w * lag), phase = w * delay + std::atan(w * lag);
  for (std::size_t k = 1000; k < time.size(); ++k)
    ASSERT_NEAR(felt[k], size * std::sin(w * time[k] - phase), 2e-4) << time[k];
}

TEST(Drive, ADelayIsNamedAndSizedBesideHealthyDrivers) {
  const HealthyReference healthy = healthy_drivers();
  for (const double delay : {1.5e-3, 3e-3}) {
    const std::optional<Told> told = told_of(log_of_driver(delay, 3e-4, 1.0, 77), &healthy);
    ASSERT_TRUE(told) << delay;
    EXPECT_EQ(told->name, "transport_delay");
    EXPECT_NEAR(told->value, delay + 5e-4 + 3e-4, 3e-4) << "half a sample of the hold, and what is felt of the lag";
  }
}

// Of the valve's own causes one stands out on each healthy log: six of eight have a size like no other's.
void add_scatter_of_valve(HealthyReference& healthy) {
  for (std::size_t i = 0; i < healthy.logs.size(); ++i)
    for (std::size_t cause = 0; cause < 6; ++cause)
      healthy.logs[i].scores.push_back(
          {"of the valve " + std::to_string(cause), "spool", {{i == cause ? 1e3 : 0.0, 1.0}}, 0, 1});
}

TEST(Drive, WhatTheValveScattersByHidesNoDriver) {
  HealthyReference healthy = healthy_drivers();
  add_scatter_of_valve(healthy);
  const Log delayed = log_of_driver(3e-3, 3e-4, 1.0, 77);
  EXPECT_FALSE(told_of(delayed, &healthy)) << "one family with all that";
  const HealthyReference of_driver = of_causes(healthy, DriveSubject({delayed}));
  EXPECT_TRUE(told_of(delayed, &of_driver));
}

// A recorder with a clock of its own shows each step of the command up to a sample late.
TEST(Drive, ADelayIsNoBetterKnownThanTheSamplesTellIt) {
  const DriveSubject drive({log_of_driver(0, 0, 1, 1)});
  for (const int cause : {DriveSubject::by_delay, DriveSubject::by_lag}) {
    const std::vector<HealthyScore> scores = score_drive(log_of_driver(0, 0, 1, 1), {});
    const auto at = static_cast<std::size_t>(cause);
    for (std::size_t k = 0; k < scores[at].sizes.size(); ++k) {
      const double probe = drive.causes()[at].probes[k].front().front();
      EXPECT_GE(scores[at].sizes[k].std_error * drive.time_beyond_usual(cause, probe), 1e-3 / std::sqrt(12.0));
    }
  }
}

TEST(Drive, ASlowAmplifierIsNamedByItsBandwidth) {
  const HealthyReference healthy = healthy_drivers();
  const std::optional<Told> told =
      told_of(log_of_driver(2e-4, 1 / (2 * pi * 30), 1.0, 78), &healthy);  // delayed as they are
  ASSERT_TRUE(told);
  EXPECT_EQ(told->name, "driver_bandwidth");
  EXPECT_NEAR(told->value, 30, 3);
}

TEST(Drive, WhatStaysWithinASampleIsShorterThanOne) {
  KnownRig known;
  known.drive_delay = {1e-3};
  const DriveSubject drive({log_of_driver(0, 0, 1, 1)}, known);
  EXPECT_NEAR(drive.sample_period(), 1e-3, 1e-12);
  EXPECT_NEAR(drive.time_beyond_usual(DriveSubject::by_delay, 3e-3), 2e-3, 1e-12);
  EXPECT_NEAR(drive.time_beyond_usual(DriveSubject::by_lag, 1 / (2 * pi * 4e-3)), 4e-3, 1e-12);
}

TEST(Drive, NothingIsSaidOfAHealthyOneNorOfItsGain) {
  const HealthyReference healthy = healthy_drivers();
  for (std::uint64_t seed = 100; seed < 110; ++seed)
    EXPECT_FALSE(told_of(log_of_driver(2e-4 * static_cast<double>(seed % 3), 3e-4, 0.95, seed), &healthy)) << seed;
}

TEST(Drive, ALogWithoutEitherOrWithoutMotionHasNone) {
  Log log = log_of_driver(0, 0, 1, 1);
  EXPECT_FALSE(DriveSubject({log}).empty());
  Log still = log;
  for (double& u : still.channels[index(Signal::command)].value) u = 1e-3;
  EXPECT_TRUE(DriveSubject({still}).empty());
  log.channels[index(Signal::coil_current)].value.clear();
  EXPECT_TRUE(DriveSubject({log}).empty());
}

}  // namespace
}  // namespace servodx
