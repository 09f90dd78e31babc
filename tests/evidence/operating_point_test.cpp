#include "servodx/operating_point.h"

#include <gtest/gtest.h>

#include <vector>

#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

Log recorded(double supply, double oil, double drive) {
  std::vector<double> time, command, pressure, temperature, piston;
  for (int i = 0; i < 200; ++i) {
    time.push_back(1e-3 * i), command.push_back(i % 2 ? drive : -0.5 * drive), piston.push_back(1e-5 * i);
    pressure.push_back(i == 7 ? 0.3 * supply : supply), temperature.push_back(oil);
  }
  return make_log("made", {{"time [s]", time},
                           {"command [A]", command},
                           {"piston_position [m]", piston},
                           {"supply_pressure [Pa]", pressure},
                           {"oil_temperature [K]", temperature}});
}

const ConditionRow* row_of(const std::vector<ConditionRow>& rows, Condition c) {
  for (const ConditionRow& r : rows)
    if (r.of == c) return &r;
  return nullptr;
}

const Rig rig = make_rig("sheet",
                         "[valve]\nrated_current = \"20 mA\"\n[supply]\npressure = \"207 bar\"\n"
                         "return_pressure = \"5 bar\"\n");

std::vector<ConditionRow> beside(const Log& log, const std::vector<Log>& healthy) {
  std::vector<OperatingPoint> points;
  for (const Log& h : healthy) points.push_back(operating_point_of(h));
  return conditions_beside({operating_point_of(log)}, sheet_point(rig), points);
}

TEST(OperatingPoint, IsReadFromTheLogAndASpikeIsNoSupply) {
  const auto rows = beside(recorded(207e5, 313, 10e-3), {});
  EXPECT_EQ(row_of(rows, Condition::supply)->value, 207e5);
  EXPECT_EQ(row_of(rows, Condition::drive)->value, 10e-3) << "the larger side";
  EXPECT_EQ(row_of(rows, Condition::oil)->value, 313.0);
  EXPECT_FALSE(row_of(rows, Condition::return_pressure)->value);
  EXPECT_EQ(row_of(rows, Condition::return_pressure)->sheet, 5e5);
  EXPECT_FALSE(row_of(rows, Condition::load)) << "neither log nor sheet knows it";
}

TEST(OperatingPoint, ASupplyBesideItsSheetIsBeyondAndOneOfAFewPerCentIsNot) {
  EXPECT_TRUE(row_of(beside(recorded(140e5, 313, 10e-3), {}), Condition::supply)->beyond);
  EXPECT_TRUE(row_of(beside(recorded(240e5, 313, 10e-3), {}), Condition::supply)->beyond);
  EXPECT_FALSE(row_of(beside(recorded(200e5, 313, 10e-3), {}), Condition::supply)->beyond);
}

TEST(OperatingPoint, OfSeveralLogsTheOneThatIsBeyondIsSaidWhereverItStands) {
  const std::vector<OperatingPoint> healthy = {operating_point_of(recorded(207e5, 313, 1e-3))};
  const OperatingPoint inside = operating_point_of(recorded(207e5, 313, 1e-3)),
                       beyond = operating_point_of(recorded(207e5, 253, 17e-3));
  for (const auto& logs : {std::vector{inside, beyond}, std::vector{beyond, inside}}) {
    const auto rows = conditions_beside(logs, sheet_point(rig), healthy);
    EXPECT_TRUE(row_of(rows, Condition::oil)->beyond);
    EXPECT_EQ(row_of(rows, Condition::oil)->value, 253.0);
    EXPECT_TRUE(row_of(rows, Condition::drive)->beyond);
    EXPECT_EQ(row_of(rows, Condition::drive)->value, 17e-3);
    EXPECT_FALSE(row_of(rows, Condition::supply)->beyond);
  }
}

TEST(OperatingPoint, WhatFaultFreeLogsShowGoesBeforeTheSheet) {
  const std::vector<Log> healthy = {recorded(140e5, 300, 5e-3), recorded(145e5, 330, 20e-3)};
  EXPECT_FALSE(row_of(beside(recorded(140e5, 313, 10e-3), healthy), Condition::supply)->beyond);
  EXPECT_TRUE(row_of(beside(recorded(207e5, 313, 10e-3), healthy), Condition::supply)->beyond);
  EXPECT_TRUE(row_of(beside(recorded(142e5, 350, 10e-3), healthy), Condition::oil)->beyond);
  EXPECT_TRUE(row_of(beside(recorded(142e5, 313, 40e-3), healthy), Condition::drive)->beyond);
  EXPECT_FALSE(row_of(beside(recorded(142e5, 313, 1e-3), healthy), Condition::drive)->beyond)
      << "a smaller drive is inside what a larger one showed";
}

TEST(OperatingPoint, TheLogsThatTunedHaveAColumnAndStandForABaselineThatIsNotThere) {
  const std::vector<OperatingPoint> tuning = {operating_point_of(recorded(140e5, 300, 5e-3)),
                                              operating_point_of(recorded(145e5, 310, 8e-3))};
  std::vector<ConditionRow> rows = beside(recorded(142e5, 340, 7e-3), {});
  EXPECT_TRUE(row_of(rows, Condition::supply)->beyond) << "the sheet says 207 bar";
  set_beside_tuning(rows, tuning);
  EXPECT_EQ(row_of(rows, Condition::supply)->tuned_lowest, 140e5);
  EXPECT_EQ(row_of(rows, Condition::supply)->tuned_highest, 145e5);
  EXPECT_FALSE(row_of(rows, Condition::supply)->beyond);
  EXPECT_TRUE(row_of(rows, Condition::oil)->beyond);
  EXPECT_FALSE(row_of(rows, Condition::return_pressure)->tuned_lowest) << "none of them recorded it";

  std::vector<ConditionRow> judged = beside(recorded(142e5, 340, 7e-3), {recorded(207e5, 340, 7e-3)});
  set_beside_tuning(judged, tuning);
  EXPECT_TRUE(row_of(judged, Condition::supply)->beyond) << "the baseline, which set the threshold, goes first";
  EXPECT_EQ(row_of(judged, Condition::supply)->tuned_highest, 145e5);
}

}  // namespace
}  // namespace servodx
