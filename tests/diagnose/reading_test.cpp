// A healthy valve's log, made by the simulation, with one mistake made about it: the reading that mends it is found.
#include "diagnose/reading.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "diagnose/constants.h"
#include "diagnose/judgeable.h"
#include "diagnose/motion.h"
#include "diagnose/whitening.h"
#include "fit/candidate_of.h"
#include "fit/error_model.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

namespace k = diagnose_constants;

constexpr std::size_t rows = 1500;

ErrorModel any_error() {
  return {{{Signal::spool_position}, {Signal::piston_position}, {Signal::pressure_a}, {Signal::pressure_b}}};
}

// The shipped log's inputs, and what the table's valve makes of them.
Log healthy(double command_times = 1) {
  Log log = shipped_log("healthy/h12_mixed");
  for (double& x : log.channels[index(Signal::command)].value) x *= command_times;
  log.time.resize(rows);
  for (Channel& c : log.channels)
    if (!c.value.empty()) c.value.resize(rows);
  const LogData data = prepare(log, shipped_rig());
  const Trajectory run = reference_of(data, candidate_of(shipped_table()), 1);
  for (const FitChannel& c : data.channels)
    log.channels[index(c.signal)].value = run.signals[static_cast<std::size_t>(c.simulated)];
  return log;
}

struct Looked {
  double as_read = 0;
  std::optional<Reading> best;
};
Looked look(const Log& log, Unjudgeable why = Unjudgeable::no) {
  const Table table = shipped_table();
  const RigFile rig = shipped_rig();
  const ErrorModel error = any_error();
  const ReadingTrial trial{table, rig, error, 1};
  return {left_as_read(log, trial), best_reading(log, why, trial)};
}

struct Case {
  std::string name;
  Reading mistake;
  double mend;  // the factor of the reading that is to be found
  Unjudgeable why = Unjudgeable::no;
};

const std::vector<Case> cases = {
    {"a rate of twice the true one", {Misreading::time_scale, 0.5}, 2.0},
    {"a rate of half the true one", {Misreading::time_scale, 2.0}, 0.5},
    {"a rate of ten times the true one", {Misreading::time_scale, 0.1}, 10.0},
    {"a rate of a tenth of the true one", {Misreading::time_scale, 10.0}, 0.1},
    {"ms taken for s", {Misreading::time_scale, 1e3}, 1e-3, Unjudgeable::too_short},
    {"the last row first", {Misreading::reversed}, 1.0},
    {"the command's sign", {Misreading::turned, -1.0, {Signal::command}}, -1.0},
    {"the command in A, said to be in mA", {Misreading::unit, 1e-3, {Signal::command}}, 1e3},
    {"inches taken for mm", {Misreading::unit, 1 / 25.4, {Signal::spool_position, Signal::piston_position}}, 25.4},
    {"psi taken for bar",
     {Misreading::unit,
      14.5038,
      {Signal::pressure_a, Signal::pressure_b, Signal::supply_pressure, Signal::return_pressure}},
     0.0689476},
    {"three columns in a round",
     {Misreading::exchanged,
      1.0,
      {Signal::spool_position, Signal::pressure_a, Signal::pressure_b},
      {Signal::pressure_a, Signal::pressure_b, Signal::spool_position}},
     1.0},
};

TEST(Reading, EachMistakeIsFoundByTheReadingThatMendsIt) {
  const Log log = healthy();
  for (const Case& c : cases) {
    const Looked seen = look(read_as(log, c.mistake), c.why);
    ASSERT_TRUE(seen.best) << c.name;
    EXPECT_EQ(seen.best->kind, c.mistake.kind) << c.name;
    EXPECT_NEAR(seen.best->factor, c.mend, 1e-3 * std::abs(c.mend)) << c.name;
    EXPECT_EQ(seen.best->of.size(), c.mistake.of.size()) << c.name;
    EXPECT_LT(seen.best->left, k::misread_leaves) << c.name;
    EXPECT_LT(seen.best->left, k::misread_beside * seen.as_read) << c.name;
  }
}

// From stop to stop, as a spool without its wire.
TEST(Reading, ACurrentThatNoDriverGivesIsNoReading) {
  Log log = healthy(1e3);
  for (double& x : log.channels[index(Signal::command)].value) x *= 1e-3;
  EXPECT_GT(look(log).best->left, k::misread_leaves);
}

TEST(Reading, SensorsThatAreLateAreFoundWithTheirLag) {
  Log log = healthy();
  constexpr long late = 50;  // samples of 1 ms
  for (const Signal s : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b}) {
    std::vector<double>& x = log.channels[index(s)].value;
    x.insert(x.begin(), late, x.front());
    x.resize(rows);
  }
  const Looked seen = look(log);
  ASSERT_TRUE(seen.best);
  EXPECT_EQ(seen.best->kind, Misreading::late);
  EXPECT_NEAR(seen.best->factor, 0.05, 0.003);
  EXPECT_LT(seen.best->left, k::misread_leaves);
}

TEST(Reading, AHealthyLogLeavesNothingToMend) {
  EXPECT_LT(look(healthy()).as_read, 1e-6);
  const Looked recorded = look(shipped_log("healthy/h12_mixed"));
  EXPECT_GT(recorded.best->left, k::misread_beside * recorded.as_read);
}

// A part of the motion: of the log's and of health's together.
TEST(Motion, WhatIsLeftIsNoneOfTheSameAllOfAnotherAndTwiceOfTheOpposite) {
  LogData data = prepare(healthy(), shipped_rig());
  const Trajectory run = reference_of(data, candidate_of(shipped_table()), 1);
  Trajectory still = run, opposite = run;
  for (auto& signal : still.signals)
    for (double& x : signal) x = 0;
  for (auto& signal : opposite.signals)
    for (double& x : signal) x = -x;
  EXPECT_NEAR(mean_left(motion_left(data, run, run), 1), 0, 1e-6);
  EXPECT_NEAR(mean_left(motion_left(data, run, still), 1), 1, 1e-3) << "a constant says nothing";
  EXPECT_NEAR(mean_left(motion_left(data, run, opposite), 1), 2, 1e-3);
  // A dead valve leaves nothing to a simulation of a dead one.
  for (FitChannel& c : data.channels) std::fill(c.measured.begin(), c.measured.end(), 0.0);
  EXPECT_NEAR(mean_left(motion_left(data, run, still), 1), 0, 1e-6);
  EXPECT_NEAR(mean_left(motion_left(data, run, run), 1), 1, 1e-3);
}

TEST(Motion, NothingThatMovesLeavesNothingToSay) {
  LogData data = prepare(healthy(), shipped_rig());
  Trajectory still = reference_of(data, candidate_of(shipped_table()), 1);
  for (auto& signal : still.signals)
    for (double& x : signal) x = 0;
  for (FitChannel& c : data.channels) std::fill(c.measured.begin(), c.measured.end(), 0.0);
  EXPECT_TRUE(motion_left(data, still, still).empty());
  EXPECT_EQ(mean_left({}, 0.5), 0.5);
}

}  // namespace
}  // namespace servodx
