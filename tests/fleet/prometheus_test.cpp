// The text for Prometheus: which valve a log is of, what is said of each, and what a name may hold.
#include "fleet/prometheus.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <sstream>

#include "fleet/fleet_verdict.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

bool has_line(const std::string& text, const std::string& wanted) {
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);)
    if (line == wanted) return true;
  return false;
}

TEST(Prometheus, AValveIsItsLogsNameWithoutDateOrNumber) {
  EXPECT_EQ(valve_of_log("in/V7_20261125T1200Z.csv"), "V7");
  EXPECT_EQ(valve_of_log("SN-5329_0031.csv"), "SN-5329");
  EXPECT_EQ(valve_of_log("V7_20261125_1200.csv"), "V7");
  EXPECT_EQ(valve_of_log("rig 3_2026-11-25 12:00:31.csv"), "rig 3");
  EXPECT_EQ(valve_of_log("h12.csv"), "h12");
  EXPECT_EQ(valve_of_log("0031.csv"), "0031");
  EXPECT_EQ(valve_of_log("left_aileron.csv"), "left_aileron");
}

TEST(Prometheus, ALaterLogReplacesWhatIsKnownOfItsValveAndAnOlderOneDoesNot) {
  ValveGauges gauges;
  gauges.take("V7_2.csv", {FleetVerdict::fault, "clogged_filter", 2.5, 200});
  gauges.take("V7_1.csv", {FleetVerdict::healthy, "", 0.5, 100});
  gauges.take("V8_1.csv", {FleetVerdict::unknown, "", std::nan(""), 100});
  std::string text = gauges.text();
  EXPECT_TRUE(has_line(text, R"(servodx_valve_verdict{valve="V7",verdict="fault",fault="clogged_filter"} 1)")) << text;
  EXPECT_TRUE(has_line(text, R"(servodx_valve_verdict{valve="V7",verdict="healthy",fault=""} 0)")) << text;
  EXPECT_TRUE(has_line(text, R"(servodx_valve_error_ratio{valve="V7"} 2.5)")) << text;
  EXPECT_TRUE(has_line(text, R"(servodx_valve_last_seen_timestamp_seconds{valve="V7"} 200.000)")) << text;
  EXPECT_EQ(text.find(R"(servodx_valve_error_ratio{valve="V8"})"), std::string::npos) << text;
  gauges.take("V7_3.csv", {FleetVerdict::healthy, "", 0.5, 300});
  text = gauges.text();
  EXPECT_TRUE(has_line(text, R"(servodx_valve_verdict{valve="V7",verdict="fault",fault=""} 0)")) << text;
  EXPECT_TRUE(has_line(text, R"(servodx_valve_error_ratio{valve="V7"} 0.5)")) << text;
}

TEST(Prometheus, NamesMayHoldAnything) {
  ValveGauges gauges;
  gauges.take("a\"b\\c.csv", {FleetVerdict::healthy, "", 0.5, 1});
  EXPECT_TRUE(has_line(gauges.text(), R"(servodx_valve_error_ratio{valve="a\"b\\c"} 0.5)")) << gauges.text();
}

TEST(Prometheus, WhatAFolderOfResultsHoldsIsKnown) {
  const TemporaryFolder folder;
  ValveGauges none;
  none.take_results(folder / "nothing");
  none.take_results(folder.path.string());
  EXPECT_EQ(none.text().find("valve="), std::string::npos);
  folder.write("V7.json",
               R"({"command": "diagnose", "schema": 1, "results": [{"log": "in/V7_1.csv", "verdict": "healthy",
                 "fault": null, "error": 1.0, "threshold": 4.0, "probabilities": {"healthy": 0.9},
                 "severity": {"value": null, "lower": null, "upper": null, "unit": ""}}]})");
  folder.write("bad.refused.json", R"({"command": "diagnose", "schema": 1, "log": "bad.csv",
                 "refused": {"file": "bad.csv", "line": 2, "column": "", "rule": "r", "mend": "m"}})");
  ValveGauges gauges;
  gauges.take_results(folder.path.string());
  const std::string text = gauges.text();
  EXPECT_TRUE(has_line(text, R"(servodx_valve_error_ratio{valve="V7"} 0.25)")) << text;
  EXPECT_TRUE(has_line(text, "servodx_logs_set_aside 1")) << text;
  EXPECT_EQ(text.find(R"(last_seen_timestamp_seconds{valve="V7"} 0.0)"), std::string::npos) << text;
}

}  // namespace
}  // namespace servodx
