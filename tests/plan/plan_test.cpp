// Short plans on the shipped valve: limits, threads, refusals, and that a planned test tells more than a random one.
#include "plan/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.h"
#include "fit/error_model.h"
#include "fit/tuned_state.h"
#include "plan/segments.h"
#include "servodx/log.h"
#include "servodx/plan.h"
#include "servodx/table.h"
#include "shipped_data.h"

namespace servodx {
namespace {

// The shipped table as if tuned: errors of the size that the shipped logs leave.
Table tuned_table() {
  Table table = shipped_table();
  TunedState state;
  state.error.channels = {{Signal::spool_position, 1e-6, 0.02, 200},
                          {Signal::piston_position, 2e-5, 0.02, 50},
                          {Signal::pressure_a, 5e4, 0.02, 100},
                          {Signal::pressure_b, 5e4, 0.02, 100}};
  set_tuned_state(table, state);
  return table;
}

PlanOptions short_plan() {
  PlanOptions o;
  o.seconds = 0.35;  // one piece
  o.rounds = 1;
  o.faults = {{"clogged_filter", 0.6}};
  return o;
}

PlannedTest planned(const PlanOptions& options) {
  return plan_of(tuned_table(), shipped_rig(), options, nullptr, nullptr);
}

std::string refused(const PlanOptions& options) {
  try {
    planned(options);
  } catch (const InputError& e) {
    return e.where.file;
  }
  return "";
}

// Two tests look at the same plan.
const PlannedTest& closed_loop_plan() {
  static const PlannedTest test = [] {
    PlanOptions o = short_plan();
    o.loop_gain = 2.0;
    o.threads = 1;
    return planned(o);
  }();
  return test;
}

TEST(Plan, TellsMoreThanARandomTestOfTheSameLengthAndLimits) {
  const PlannedTest& test = closed_loop_plan();
  ASSERT_EQ(test.time.size(), 350u);
  EXPECT_EQ(test.command.size(), test.random_command.size());
  EXPECT_GE(test.planned.information, test.random.information);
  ASSERT_EQ(test.planned.faults.size(), 1u);
  EXPECT_GT(test.planned.faults[0].deviates, test.threshold);
  EXPECT_GT(test.planned.faults[0].named, 0.5);
}

// Where the valve is as tuned, setpoint less position times the gain is the planned current.
TEST(Plan, AClosedLoopAsksForTheSameCurrent) {
  const PlannedTest& test = closed_loop_plan();
  ASSERT_EQ(test.setpoint.size(), test.command.size());
  for (std::size_t n = 0; n < test.command.size(); ++n)
    EXPECT_NEAR(2.0 * (test.setpoint[n] - test.whole->piston[n]), test.command[n], 1e-12);
}

TEST(Plan, IsTheSameForAnyNumberOfThreads) {
  PlanOptions o = short_plan();
  o.threads = 3;
  const PlannedTest three = planned(o);
  EXPECT_EQ(three.command, closed_loop_plan().command);
  EXPECT_EQ(three.planned.information, closed_loop_plan().planned.information);
}

TEST(Plan, KeepsItsLimits) {
  PlanOptions o = short_plan();
  o.rounds = 0;
  o.limits.current = 0.5;
  o.limits.stroke = 8e-3;  // a healthy null alone drifts half of that
  o.limits.speed = 0.15;
  o.limits.pressure = 180e5;  // above what offsets and null put into a chamber at rest
  const PlannedTest test = planned(o);
  for (const PlannedTest::Figures* f : {&test.planned, &test.random}) {
    const PlannedTest::Extremes& e = f->extremes;
    EXPECT_GT(e.current, 0.0);
    EXPECT_LE(e.current, 0.5 * 0.02 + 1e-12);
    EXPECT_LE(e.stroke, 8e-3);
    EXPECT_LE(e.speed, 0.15);
    EXPECT_LE(e.pressure_high, 180e5);
    EXPECT_GE(e.pressure_low, -1e5);  // oil holds no tension
    EXPECT_EQ(e.cavitates, e.pressure_low == -1e5);
  }
}

TEST(Plan, RowsAreKnownBetterAfterIt) {
  PlanOptions o = short_plan();
  o.rounds = 0;
  o.faults.clear();
  o.rows = {"torque_motor_gain"};
  const PlannedTest test = planned(o);
  ASSERT_EQ(test.planned.rows.size(), 1u);
  EXPECT_LT(test.planned.rows[0].after, test.planned.rows[0].before);
}

TEST(Plan, RefusesWhatItCannotPlanFor) {
  PlanOptions o = short_plan();
  o.faults = {{"driver_fault"}};  // its record tells it, no fit
  EXPECT_EQ(refused(o), "--faults");
  o.faults = {{"clogged_filter", 1.5}};
  EXPECT_EQ(refused(o), "--faults");
  o = short_plan();
  o.faults.clear(), o.rows = {"no_such_row"};
  EXPECT_EQ(refused(o), "--rows");
  o = short_plan();
  o.limits.pressure = 1e5;  // a chamber at rest holds half of the supply
  EXPECT_NE(refused(o).find("--max-pressure"), std::string::npos);
}

}  // namespace
}  // namespace servodx
