// The GA paper's sensitivity table: each of its 41 parameters driven to minimum and maximum, ranked by the effect.
#include "servodx/sensitivity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

// The first half second: enough to drive every row by.
Log short_log() {
  Log log = shipped_log("healthy/h12_mixed");
  constexpr std::size_t samples = 500;
  log.time.resize(samples);
  for (auto& channel : log.channels)
    if (channel.value.size() > samples) channel.value.resize(samples);
  return log;
}

const DrivenRow& row_of(const Sensitivity& s, const std::string& name) {
  return *std::find_if(s.rows.begin(), s.rows.end(), [&](const DrivenRow& r) { return r.name == name; });
}

TEST(GaPaperSensitivity, TableDrivesAllFortyOneRowsHeldOnesTooAndRanksThem) {
  const Sensitivity s = drive_rows({short_log()}, shipped_table(), shipped_rig(), 1, {});
  ASSERT_EQ(s.rows.size(), 41u);
  std::set<int> ids;
  bool held = false;
  for (std::size_t j = 0; j < s.rows.size(); ++j) {
    const DrivenRow& r = s.rows[j];
    ids.insert(r.id);
    held = held || (!r.estimate && r.largest() > 1);
    EXPECT_LT(r.ends[0].value, r.ends[1].value) << r.name;
    EXPECT_EQ(r.ends[0].by_channel.size(), s.channels.size());
    if (j > 0 && !std::isnan(r.largest())) {
      EXPECT_LE(r.largest(), s.rows[j - 1].largest()) << r.name;
    }
  }
  EXPECT_EQ(ids.size(), 41u);
  EXPECT_EQ(*ids.begin(), 1);
  EXPECT_TRUE(held);
  // A motor of a twentieth of its gain hardly moves the spool: far beyond its sensor's noise.
  EXPECT_GT(row_of(s, "torque_motor_gain").ends[0].effect, 10);
  EXPECT_EQ(s.simulations, 83);
}

TEST(GaPaperSensitivity, EffectIsTheRmsChangeOverTheNoise) {
  const Log log = short_log();
  const Sensitivity s = drive_rows({log}, shipped_table(), shipped_rig(), 1, {});
  const LogData data = prepare(log, shipped_rig());
  ParameterVector candidate = candidate_of(shipped_table());
  const Trajectory before = simulate(data.scenario, candidate);
  candidate[row::nozzle_gap] = shipped_table()[row::nozzle_gap].upper;
  const Trajectory after = simulate(data.scenario, candidate);
  const auto channel = std::find(s.channels.begin(), s.channels.end(), Signal::spool_position) - s.channels.begin();
  const auto at = static_cast<std::size_t>(simulated_index(Signal::spool_position));
  double squares = 0;
  for (std::size_t k = 0; k < log.time.size(); ++k)
    squares += std::pow(after.signals[at][k] - before.signals[at][k], 2);
  const double noise = std::find_if(data.channels.begin(), data.channels.end(), [](const FitChannel& c) {
                         return c.signal == Signal::spool_position;
                       })->noise;
  const double expected = std::sqrt(squares / static_cast<double>(log.time.size())) / noise;
  EXPECT_NEAR(row_of(s, "nozzle_gap").ends[1].by_channel[static_cast<std::size_t>(channel)], expected, 0.02 * expected);
}

TEST(GaPaperSensitivity, ARowAtWhichTheRunFailsIsSaidWithItsLog) {
  Table broken = shipped_table();
  broken[row::torque_motor_frequency].upper = 1e200;  // its square is beyond all numbers
  const Sensitivity s = drive_rows({short_log()}, broken, shipped_rig(), 1, {});
  const DrivenRow& r = row_of(s, "torque_motor_frequency");
  ASSERT_EQ(r.ends[1].failed.size(), 1u);
  EXPECT_EQ(r.ends[1].failed.front(), shipped("data/healthy/h12_mixed.csv"));
  EXPECT_TRUE(std::isnan(r.ends[1].effect));
  EXPECT_FALSE(std::isnan(r.largest()));
  EXPECT_GE(s.failed_simulations, 1);
}

}  // namespace
}  // namespace servodx
