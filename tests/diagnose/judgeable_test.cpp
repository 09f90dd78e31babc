// Logs that hold nothing to judge, each made of a shipped one; and all shipped ones, which do.
#include "diagnose/judgeable.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/random.h"
#include "diagnose/decide.h"
#include "faults/record.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/operating_point.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

LogData usual() { return prepare(shipped_log("healthy/h12_mixed"), shipped_rig()); }

Unjudgeable look(const LogData& log) { return unjudgeable(log, candidate_of(shipped_table())); }

TEST(Judgeable, EveryShippedLogIs) {
  int logs = 0;
  for (const char* folder : {"healthy", "fault", "sudden"})
    for (const auto& entry : std::filesystem::directory_iterator(shipped(std::string("data/") + folder))) {
      if (entry.path().extension() != ".csv") continue;
      const LogData log = prepare(read_log(entry.path().string(), shipped_rig()), shipped_rig());
      EXPECT_EQ(look(log), Unjudgeable::no) << entry.path();
      ++logs;
    }
  EXPECT_GT(logs, 20);
}

TEST(Judgeable, NotWhereNothingIsAsked) {
  LogData log = usual();
  std::fill(log.scenario.command.begin(), log.scenario.command.end(), 1e-3);
  std::fill(log.scenario.supply_pressure.begin(), log.scenario.supply_pressure.end(), 2e7);
  std::fill(log.scenario.load_force.begin(), log.scenario.load_force.end(), 0.0);
  EXPECT_EQ(look(log), Unjudgeable::nothing_asked);
}

TEST(Judgeable, NotWhereOnlyTheSupplyMovesAndNoSensorAnswers) {
  LogData log = usual();
  std::fill(log.scenario.command.begin(), log.scenario.command.end(), 1e-3);
  for (std::size_t i = 0; i < log.scenario.supply_pressure.size(); ++i)
    log.scenario.supply_pressure[i] = 2e7 + 2e6 * std::sin(0.05 * static_cast<double>(i));
  EXPECT_EQ(look(log), Unjudgeable::command_missing) << "the spool moves";
  Random random(8);
  for (FitChannel& c : log.channels)
    for (double& x : c.measured) x = c.noise * random.normal();
  EXPECT_EQ(look(log), Unjudgeable::nothing_asked);
}

TEST(Judgeable, NotWhereASpoolIsBeyondItsStops) {
  const double stop = candidate_of(shipped_table())[row::spool_stop];
  LogData log = usual(), off = usual();
  const auto spool = [](LogData& of) -> FitChannel& {
    return *std::find_if(of.channels.begin(), of.channels.end(),
                         [](const FitChannel& c) { return c.signal == Signal::spool_position; });
  };
  for (std::size_t i = 0; i < log.scenario.time.size(); ++i) {
    const double swing = std::sin(0.01 * static_cast<double>(i));
    spool(log).measured[i] = 5 * stop * swing;    // another column
    spool(off).measured[i] = 1.5 * stop * swing;  // a sensor's gain
  }
  EXPECT_EQ(look(log), Unjudgeable::position_beyond_travel);
  EXPECT_EQ(look(off), Unjudgeable::no);
}

TEST(Judgeable, NotWhereEverySensorStandsStillButWhereOneDoes) {
  LogData log = usual();
  std::fill(log.channels[0].measured.begin(), log.channels[0].measured.end(), 0.0);
  EXPECT_EQ(look(log), Unjudgeable::no);
  for (FitChannel& c : log.channels) std::fill(c.measured.begin(), c.measured.end(), 3.0);
  EXPECT_EQ(look(log), Unjudgeable::sensors_still);
}

TEST(Judgeable, NotWhereNoiseIsAll) {
  const ParameterVector base = candidate_of(shipped_table());
  LogData log = usual();
  Random random(5);
  for (FitChannel& c : log.channels) {
    const double size = c.signal == Signal::spool_position    ? base[row::spool_stop]
                        : c.signal == Signal::piston_position ? base[row::piston_stroke]
                                                              : base[row::supply_pressure];
    for (double& x : c.measured) x = 0.1 * size * random.normal();
  }
  EXPECT_EQ(look(log), Unjudgeable::noise_alone);
}

// As large as the healthy log's own scatter: 1.4 bar of the pressures.
void answer_with_noise(FitChannel& c, std::uint64_t seed) {
  double mean = 0, square = 0;
  for (const double x : c.measured) mean += x / static_cast<double>(c.measured.size());
  for (const double x : c.measured) square += (x - mean) * (x - mean) / static_cast<double>(c.measured.size());
  Random random(seed);
  for (double& x : c.measured) x = mean + std::sqrt(square) * random.normal();
}

TEST(Judgeable, NotWhereNoiseAnswersTheTrueCommandButWhereOneSensorMoves) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    LogData log = usual();
    for (FitChannel& c : log.channels) answer_with_noise(c, seed + 10 * static_cast<std::uint64_t>(c.signal));
    EXPECT_EQ(look(log), Unjudgeable::noise_alone);
  }
  for (const Signal moves : {Signal::spool_position, Signal::piston_position, Signal::pressure_a}) {
    LogData log = usual();
    for (FitChannel& c : log.channels)
      if (c.signal != moves) answer_with_noise(c, 4);
    EXPECT_NE(look(log), Unjudgeable::noise_alone);
  }
}

// A noisy sensor shows the command all the same.
TEST(Judgeable, ASpoolThatFollowsTheCommandUnderMuchNoiseIs) {
  LogData log = usual();
  for (FitChannel& c : log.channels) answer_with_noise(c, 5);
  Random random(6);
  FitChannel& spool = *std::find_if(log.channels.begin(), log.channels.end(),
                                    [](const FitChannel& c) { return c.signal == Signal::spool_position; });
  FitChannel& piston = *std::find_if(log.channels.begin(), log.channels.end(),
                                     [](const FitChannel& c) { return c.signal == Signal::piston_position; });
  for (double& x : piston.measured) x = piston.noise * random.normal();
  const double per_rated = 0.5e-3 / log.scenario.rated_current;
  for (std::size_t i = 0; i < spool.measured.size(); ++i)
    spool.measured[i] = per_rated * log.scenario.command[i] + 2e-4 * random.normal();
  EXPECT_EQ(look(log), Unjudgeable::no);
}

TEST(Judgeable, NotWhereTheRowsAreShuffled) {
  LogData log = usual();
  Random random(6);
  for (std::size_t i = log.scenario.time.size() - 1; i > 0; --i) {
    const auto j = static_cast<std::size_t>(random.below(static_cast<std::uint32_t>(i + 1)));
    std::swap(log.scenario.command[i], log.scenario.command[j]);
    for (FitChannel& c : log.channels) std::swap(c.measured[i], c.measured[j]);
  }
  EXPECT_EQ(look(log), Unjudgeable::noise_alone);
}

TEST(Judgeable, ASpoolThatIsJammedUnderADeadSupplyIs) {
  // The sensors' noise is left, and the fits have to say what it is.
  LogData log = usual();
  Random random(7);
  for (FitChannel& c : log.channels)
    for (double& x : c.measured) x = c.noise * random.normal();
  EXPECT_EQ(look(log), Unjudgeable::no);
}

TEST(Judgeable, NotWhereUnitsAreTakenForOthers) {
  LogData large = usual(), high = usual(), slow = usual(), fast = usual();
  for (double& i : large.scenario.command) i *= 100;
  EXPECT_EQ(look(large), Unjudgeable::command_too_large);
  for (FitChannel& c : high.channels)
    if (c.signal == Signal::pressure_a || c.signal == Signal::pressure_b)
      for (double& p : c.measured) p *= 14.5;
  EXPECT_EQ(look(high), Unjudgeable::pressure_beyond_supply);
  for (double& t : slow.scenario.time) t *= 1e3;
  for (double& t : fast.scenario.time) t *= 1e-3;
  EXPECT_EQ(look(slow), Unjudgeable::too_short);
  EXPECT_EQ(look(fast), Unjudgeable::too_short);
}

FitChannel& channel(LogData& log, Signal signal) {
  return *std::find_if(log.channels.begin(), log.channels.end(),
                       [&](const FitChannel& c) { return c.signal == signal; });
}

TEST(Judgeable, NotWherePressuresAreInNoOrder) {
  LogData swapped = usual(), negative = usual(), dead = usual();
  std::swap(channel(swapped, Signal::pressure_a).measured, swapped.scenario.return_pressure);
  EXPECT_EQ(look(swapped), Unjudgeable::pressures_out_of_order);
  for (double& p : channel(negative, Signal::pressure_b).measured) p = -p;
  EXPECT_EQ(look(negative), Unjudgeable::pressures_out_of_order);
  std::fill(dead.scenario.supply_pressure.begin(), dead.scenario.supply_pressure.end(), 1e5);
  EXPECT_EQ(look(dead), Unjudgeable::no) << "the chambers hardly move";
  const double first = channel(dead, Signal::pressure_a).measured.front();
  for (double& p : channel(dead, Signal::pressure_a).measured) p = first + 5 * (p - first);
  EXPECT_EQ(look(dead), Unjudgeable::pressures_out_of_order) << "the chambers move";
  for (const Signal s : {Signal::pressure_a, Signal::pressure_b})
    std::fill(channel(dead, s).measured.begin(), channel(dead, s).measured.end(), 9e6);
  EXPECT_EQ(look(dead), Unjudgeable::no) << "shut in, with the pump off";
}

TEST(Judgeable, NotWhereThePistonIsElsewhereFromOneRowToTheNext) {
  LogData log = usual(), spike = usual();
  std::vector<double>& x = channel(log, Signal::piston_position).measured;
  for (std::size_t i = x.size() / 2; i < x.size(); ++i) x[i] += 0.05;
  EXPECT_EQ(look(log), Unjudgeable::rows_jump);
  channel(spike, Signal::piston_position).measured[500] += 0.05;
  EXPECT_EQ(look(spike), Unjudgeable::no);
}

TEST(Judgeable, NotWhereTwoChannelsAreOne) {
  LogData log = usual();
  channel(log, Signal::pressure_b).measured = channel(log, Signal::pressure_a).measured;
  EXPECT_EQ(look(log), Unjudgeable::copied);
}

TEST(Judgeable, NotWhereEveryChannelThatMovesShowsAHandfulOfValues) {
  LogData log = usual();
  const auto in_steps = [](FitChannel& c) {
    const auto [low, high] = std::minmax_element(c.measured.begin(), c.measured.end());
    const double from = *low, step = (*high - *low) / 7;
    for (double& x : c.measured) x = from + step * std::round((x - from) / step);
  };
  for (FitChannel& c : log.channels) in_steps(c);
  EXPECT_EQ(look(log), Unjudgeable::coarse);
  LogData one = usual();
  in_steps(channel(one, Signal::spool_position));
  EXPECT_EQ(look(one), Unjudgeable::no) << "the others tell";
}

TEST(Judgeable, NotInOilThatNoOilIs) {
  OperatingPoint point = {};
  EXPECT_EQ(unjudgeable(point), Unjudgeable::no);
  point[static_cast<std::size_t>(Condition::oil)] = 353.0;
  EXPECT_EQ(unjudgeable(point), Unjudgeable::no);
  point[static_cast<std::size_t>(Condition::oil)] = 673.0;
  EXPECT_EQ(unjudgeable(point), Unjudgeable::oil_beyond);
}

// The fits say a fault without a doubt, and the verdict is that there is nothing to judge.
TEST(Judgeable, NothingElseIsSaidOfALogThatIsNot) {
  Evidence e;
  e.error = e.gain = 90, e.threshold = 3, e.usual_adequacy = 1;
  e.hypotheses = {{nullptr, 0.0, 50.0}, {find_fault("torque_motor_loss"), 1.0, 1.0, false, 8100.0}};
  e.records = {{Record::sensor, true}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
  e.unjudgeable = Unjudgeable::noise_alone;
  const Decision d = decide(e);
  EXPECT_EQ(d.verdict, VerdictKind::unknown);
  EXPECT_FALSE(d.record);
  e.error = e.gain = 1;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown) << "nor is it healthy";
}

}  // namespace
}  // namespace servodx
