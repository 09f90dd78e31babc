#include "fit/log_data.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "base/random.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/problem.h"
#include "fit/support.h"
#include "model/state.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "shipped_data.h"
#include "signals/low_pass.h"
#include "signals/noise.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

const FitChannel& channel(const LogData& log, Signal s) {
  return *std::find_if(log.channels.begin(), log.channels.end(), [&](const FitChannel& c) { return c.signal == s; });
}

TEST(Noise, OfWhiteNoiseIsItsDeviation) {
  for (unsigned seed = 0; seed < 5; ++seed) {
    Random random(seed);
    std::vector<double> x(4000);
    for (double& v : x) v = random.normal(3.0, 0.02);
    EXPECT_NEAR(noise_of(x, 0.0), 0.02, 0.002) << seed;
  }
}

TEST(Noise, MotionAndStepsDoNotCount) {
  Random random(9);
  std::vector<double> x(4000);
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] = random.normal(0.0, 0.01) + 2.0 * std::sin(1e-2 * static_cast<double>(k)) + (k / 200 % 2 ? 5.0 : 0.0);
  EXPECT_NEAR(noise_of(x, 0.0), 0.01, 0.0015);
}

TEST(Noise, LivelyMotionDoesNotCount) {  // 50 Hz, a hundred times the noise, all of the log
  Random random(9);
  std::vector<double> x(4000);
  for (std::size_t k = 0; k < x.size(); ++k)
    x[k] = random.normal(0.0, 0.01) + std::sin(0.05 * 2 * std::numbers::pi * static_cast<double>(k));
  EXPECT_NEAR(noise_of(x, 0.0), 0.01, 0.002);
}

TEST(Noise, IsAtLeastThatOfTheQuantisation) {
  EXPECT_DOUBLE_EQ(noise_of(std::vector<double>(100, 1.0), 0.12), 0.12 / std::sqrt(12.0));
  EXPECT_DOUBLE_EQ(noise_of({}, 0.12), 0.12 / std::sqrt(12.0));
}

TEST(LogData, SliceStartsFromWhatIsMeasuredThere) {
  const LogData whole = shipped_data("healthy/h12_mixed");
  constexpr std::size_t from = 1234, to = 2000;
  const LogData part = slice(whole, from, to);
  ASSERT_EQ(part.scenario.time.size(), to - from);
  EXPECT_EQ(part.scenario.time.front(), whole.scenario.time[from]);
  EXPECT_EQ(part.scenario.command.back(), whole.scenario.command[to - 1]);
  EXPECT_EQ(part.scenario.load_force.front(), whole.scenario.load_force[from]);
  for (std::size_t c = 0; c < part.channels.size(); ++c)
    EXPECT_EQ(part.channels[c].measured.front(), whole.channels[c].measured[from]);
  EXPECT_EQ(*part.scenario.spool_start, channel(whole, Signal::spool_position).measured[from]);
  EXPECT_EQ(*part.scenario.pressure_a_start, channel(whole, Signal::pressure_a).measured[from]);
  EXPECT_EQ(*part.scenario.pressure_b_start, channel(whole, Signal::pressure_b).measured[from]);
  EXPECT_EQ(*part.scenario.piston_start, channel(whole, Signal::piston_position).measured[from]);

  SimulateOptions o;
  o.wanted.fill(true);
  const Trajectory t = simulate(part.scenario, candidate_of(shipped_table()), o);
  ASSERT_TRUE(t.ok);
  for (const FitChannel& c : part.channels) {
    const double start = c.measured.front(), simulated = t.signals[c.simulated].front();
    // The sensor's lag shifts the piston by lag times velocity; all else starts where it was measured.
    const double allowed = c.signal == Signal::piston_position
                               ? std::abs(0.001 * part.scenario.piston_velocity_start) + 1e-9
                               : 1e-6 * std::abs(start);
    EXPECT_NEAR(simulated, start, allowed) << info(c.signal).name;
  }
}

TEST(LogData, SliceStartsAtTheFirstSampleThatIsThere) {
  LogData log = shipped_data("healthy/h12_mixed");
  for (FitChannel& c : log.channels)
    if (c.signal == Signal::spool_position) c.measured[100] = c.measured[101] = std::nan("");
  EXPECT_EQ(*slice(log, 100, 300).scenario.spool_start, channel(log, Signal::spool_position).measured[102]);
}

TEST(LogData, VelocityAtTheStartIsThatOfTheMeasuredPiston) {
  LogData log = shipped_data("healthy/h12_mixed");
  for (FitChannel& c : log.channels)
    if (c.signal == Signal::piston_position)
      for (std::size_t k = 0; k < c.measured.size(); ++k) c.measured[k] = 0.01 - 0.12 * log.scenario.time[k];
  EXPECT_NEAR(slice(log, 500, 900).scenario.piston_velocity_start, -0.12, 1e-9);
}

TEST(LogData, InputThatIsMissingIsBridgedInALine) {
  Log log = shipped_log("healthy/h12_mixed");
  std::vector<double>& supply = log.channels[index(Signal::supply_pressure)].value;
  // A ramp, which the smoother passes as it is.
  for (std::size_t k = 0; k < supply.size(); ++k) supply[k] = 207e5 + 100.0 * static_cast<double>(k);
  for (int k = 11; k < 14; ++k) supply[k] = std::nan("");
  supply.front() = supply.back() = std::nan("");
  const LogData data = prepare(log, shipped_rig());
  EXPECT_NEAR(data.scenario.supply_pressure[12], 207e5 + 1200.0, 100.0);
  EXPECT_NEAR(data.scenario.supply_pressure.front(), supply[1], 100.0);
  EXPECT_NEAR(data.scenario.supply_pressure.back(), supply[supply.size() - 2], 100.0);
}

// A load on oil springs answers the noise of its force sensor as if it were force: the scenario holds less of it.
TEST(LogData, NoiseOfAMeasuredForceDoesNotDriveTheLoad) {
  Log log = shipped_log("healthy/h12_mixed");
  Random random(3);
  std::vector<double>& force = log.channels[index(Signal::load_force)].value;
  force.resize(log.time.size());
  for (double& f : force) f = 500.0 + 30.0 * random.normal();
  double sum = 0;
  const LogData data = prepare(log, shipped_rig());
  for (double f : data.scenario.load_force) sum += (f - 500.0) * (f - 500.0);
  EXPECT_LT(std::sqrt(sum / static_cast<double>(force.size())), 10.0);
}

TEST(LogData, WhatFollowsAGapIsNotComparedAsLongAsItWasOrTheValveRemembers) {
  Log log = shipped_log("healthy/h12_mixed");
  const auto without = [&](std::size_t from, std::size_t to) {
    Log cut = log;
    const auto drop = [&](std::vector<double>& v) {
      if (!v.empty()) v.erase(v.begin() + static_cast<long>(from), v.begin() + static_cast<long>(to));
    };
    drop(cut.time);
    for (Channel& c : cut.channels) drop(c.value);
    return prepare(cut, shipped_rig());
  };
  const auto lost = [&](const LogData& data) {
    const auto& x = channel(data, Signal::spool_position).measured;
    return std::count_if(x.begin(), x.end(), [](double v) { return std::isnan(v); });
  };
  EXPECT_EQ(lost(prepare(log, shipped_rig())), 0);
  EXPECT_NEAR(static_cast<double>(lost(without(1000, 1004))), 5, 1);   // 4 samples lost: a step of 5 ms
  EXPECT_NEAR(static_cast<double>(lost(without(1000, 1500))), 10, 1);  // 10 ms
  EXPECT_TRUE(std::isnan(channel(without(1000, 1500), Signal::pressure_a).measured[1000]));
}

// A log as a rig with a low-pass would have recorded it: the simulation meets it where the rig file says so, and lags
// behind nothing where it does not.
TEST(LogData, TheRigsLowPassIsPutOnWhatIsSimulated) {
  Log log = shipped_log("healthy/h01_steps_large");
  RigFile rig = shipped_rig();
  const Table table = shipped_table();
  const LogData as_seen = prepare(log, rig);
  const Trajectory run = FitProblem({&as_seen}, candidate_of(table), {}).trajectories({}).front();
  ASSERT_TRUE(run.ok);
  rig.facts["measurement.low_pass"] = 80;
  rig.facts["measurement.low_pass.piston_position"] = 20;
  rig.words["measurement.low_pass_order"] = "4";
  const LogData behind = prepare(log, rig);
  for (const FitChannel& c : behind.channels) {
    std::vector<double>& of_log = log.channels[index(c.signal)].value;
    of_log = run.signals[static_cast<std::size_t>(c.simulated)];
    LowPass(log.time, c.signal == Signal::piston_position ? 20 : 80, 4)(of_log);
  }
  const auto left = [&](const RigFile& with) {
    LogData data = prepare(log, with);
    data.scenario = as_seen.scenario;  // started alike
    const FitProblem problem({&data}, candidate_of(table), {});
    double worst = 0;
    for (std::size_t c = 0; c < data.channels.size(); ++c)
      for (const double r : problem.raw_residual(0, static_cast<int>(c), run))
        worst = std::max(worst, std::abs(r) / data.channels[c].noise);
    return worst;
  };
  EXPECT_LT(left(rig), 1e-6);
  EXPECT_GT(left(shipped_rig()), 10);
}

TEST(LogData, APartOfALogKeepsItsLowPass) {
  RigFile rig = shipped_rig();
  rig.facts["measurement.low_pass"] = 80;
  const Log log = shipped_log("healthy/h01_steps_large");
  const LogData part = slice(prepare(log, rig), 100, 400);
  const std::vector<double> ramp = std::vector<double>(part.channels[0].measured.size(), 2.0);
  ASSERT_EQ(ramp.size(), 300u);
  for (const double v : part.channels[0].shown(ramp)) EXPECT_NEAR(v, 2.0, 1e-12);
}

TEST(LogData, MeasuredCurrentDrivesInPlaceOfTheCommand) {
  Log log = shipped_log("healthy/h12_mixed");
  Channel& coil = log.channels[index(Signal::coil_current)];
  coil.value = log[Signal::command];
  for (double& i : coil.value) i *= 0.5;
  const LogData data = prepare(log, shipped_rig());
  EXPECT_TRUE(data.scenario.current_measured);
  EXPECT_EQ(data.scenario.command, coil.value);
}

TEST(LogData, LogWithoutSupplyTakesTheTables) {
  EXPECT_TRUE(shipped_data("healthy/h15_no_supply_signals").scenario.supply_pressure.empty());
  EXPECT_FALSE(shipped_data("healthy/h12_mixed").scenario.supply_pressure.empty());
}

TEST(LogData, OilIsAsWarmAsTheLogSaysElseAsTheRigFileSays) {
  RigFile rig = shipped_rig();
  Log log = shipped_log("healthy/h12_mixed");
  const LogData recorded = prepare(log, rig);
  rig.oil_temperature = 353.15;
  EXPECT_EQ(prepare(log, rig).scenario.oil.dynamic_viscosity, recorded.scenario.oil.dynamic_viscosity);
  log.channels[index(Signal::oil_temperature)] = {};
  const LogData stated = prepare(log, rig);
  EXPECT_TRUE(stated.scenario.oil_known);
  const Oil hot = oil_at(rig.fluid.density, rig.fluid.kinematic_viscosity, 353.15);
  EXPECT_EQ(stated.scenario.oil.dynamic_viscosity, hot.dynamic_viscosity);
  rig.fluid.kinematic_viscosity_100 = 3.5e-6;  // a steeper oil than is taken where the rig file does not say
  const Oil steep = oil_at(rig.fluid.density, rig.fluid.kinematic_viscosity, 353.15, 3.5e-6);
  EXPECT_EQ(prepare(log, rig).scenario.oil.dynamic_viscosity, steep.dynamic_viscosity);
  EXPECT_LT(steep.dynamic_viscosity, hot.dynamic_viscosity);
  rig.oil_temperature.reset();
  EXPECT_FALSE(prepare(log, rig).scenario.oil_known);
}

TEST(LogData, WhatIsAssumedOrLeftOutIsNotedByItsKind) {
  const auto kinds_of = [](const std::vector<Note>& notes) {
    std::vector<Note::Kind> kinds;
    for (const Note& note : notes) kinds.push_back(note.kind);
    return kinds;
  };
  using Kinds = std::vector<Note::Kind>;
  Log log = shipped_log("healthy/h12_mixed");
  log.notes = {{Note::Kind::gaps, "of the reader"}};
  EXPECT_EQ(kinds_of(prepare(log, shipped_rig()).notes), Kinds{Note::Kind::gaps}) << "all is logged";
  log.channels[index(Signal::oil_temperature)] = {};
  log.channels[index(Signal::load_pressure)].value = log[Signal::pressure_a];
  LogData data = prepare(log, shipped_rig());
  EXPECT_EQ(kinds_of(data.notes), (Kinds{Note::Kind::gaps, Note::Kind::oil, Note::Kind::redundant_signal}));
  const std::size_t channels = data.channels.size();
  EXPECT_EQ(kinds_of(leave_out_unknown_channels(data, ErrorModel{})), Kinds(channels, Note::Kind::unlearnt_signal));
  EXPECT_TRUE(data.channels.empty());
}

}  // namespace
}  // namespace servodx
