// Several logs of one valve in one state: what one of them shows counts, whichever it is.
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "diagnose/assessment.h"
#include "diagnose/gross.h"
#include "diagnose/motion_by_hypothesis.h"
#include "diagnose/ready_logs.h"
#include "faults/gross_finding.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

LogData log_of(const char* name) { return prepare(shipped_log(name), shipped_rig()); }

ReadyLogs pool_of(std::vector<LogData> logs) {
  ReadyLogs out;
  out.recorded.resize(logs.size());
  out.data = std::move(logs);
  return out;
}

TEST(Pool, WhatOneOfItsLogsShowsOutrightIsSeenWhicheverItIs) {
  const ParameterVector base = candidate_of(shipped_table());
  const LogData healthy = log_of("healthy/h12_mixed");
  LogData jammed = healthy;
  for (FitChannel& c : jammed.channels)
    if (c.signal == Signal::spool_position) c.measured.assign(c.measured.size(), 0.0);
  ASSERT_EQ(gross_finding(healthy, base), GrossFinding::none);
  ASSERT_EQ(gross_finding(jammed, base), GrossFinding::no_response);
  EXPECT_EQ(gross_finding(pool_of({healthy, jammed}), base), GrossFinding::no_response);
  EXPECT_EQ(gross_finding(pool_of({jammed, healthy}), base), GrossFinding::no_response);
  EXPECT_EQ(gross_finding(pool_of({healthy, healthy}), base), GrossFinding::none);
}

TEST(Pool, ItsMotionIsTheMeanOverItsLogs) {
  const ParameterVector base = candidate_of(shipped_table());
  const std::vector<HypothesisPrediction> predictions = {{.fault = nullptr, .candidate = base}};
  const LogData one = log_of("healthy/h12_mixed"), other = log_of("healthy/h05_prbs");
  const MotionByHypothesis of_one = motion_by_hypothesis(one, base, predictions, {}, 1),
                           of_other = motion_by_hypothesis(other, base, predictions, {}, 1),
                           both = motion_by_hypothesis({one, other}, base, predictions, {}, 1);
  ASSERT_NE(of_one.left.front().part, of_other.left.front().part);
  EXPECT_DOUBLE_EQ(both.left.front().part, (of_one.left.front().part + of_other.left.front().part) / 2);
  EXPECT_DOUBLE_EQ(both.others, (of_one.others + of_other.others) / 2);
}

}  // namespace
}  // namespace servodx
