// Failure levels from performance limits, by linear theory.
#include "prognose/performance_limits.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "prognose/monitor.h"
#include "prognose/trend_options.h"
#include "support.h"

namespace servodx {
namespace {

// papers.md: three times slower gives 1.76 at T = 3 time constants.
TEST(Limits, FidelityOfASlowerSpoolIsThatOfTheory) {
  EXPECT_NEAR(fidelity_of_slower(3), 1.76, 0.01);
  EXPECT_NEAR(fidelity_of_slower(1), 1.0, 1e-12);
}

// The blockage that the limit names, put into the table, leaves that part of the monitor's bandwidth.
TEST(Limits, BlockageForABandwidthLeavesThatBandwidth) {
  Table table = shipped_table();
  TrendSettings options;
  add_limit(read_limit("bandwidth=0.5"), table, 0, options);
  const Supply at{207e5, 5e5, {}, 0.02};
  const double healthy = monitor_parameters(table, at).first_stage_gain;
  table[row::filter_blockage_positive].nominal = table[row::filter_blockage_negative].nominal =
      *options.failure.at("parameter:1").second;
  EXPECT_NEAR(monitor_parameters(table, at).first_stage_gain / healthy, 0.5, 1e-6);
}

TEST(Limits, ABacklashOfTheHysteresisLimitTakesThatMuchCurrent) {
  const Table table = shipped_table();
  TrendSettings options;
  add_limit(read_limit("hysteresis=0.04"), table, 0, options);
  // 4 % of rated current moves a spool of 0.5 mm stroke by 20 um at most: the flow force takes some.
  EXPECT_NEAR(*options.failure.at("parameter:9").second, 20e-6, 4e-6);
}

TEST(Limits, WhatIsNoLimitIsRefused) {
  const Table table = shipped_table();
  TrendSettings options;
  for (const char* text : {"bandwidth", "bandwidth=2", "speed=0.5", "phase_margin=45"})
    EXPECT_THROW(add_limit(read_limit(text), table, 0, options), InputError) << text;
  add_limit(read_limit("phase_margin=85"), table, 15, options);
  EXPECT_TRUE(options.failure.contains("parameter:1"));
}

}  // namespace
}  // namespace servodx
