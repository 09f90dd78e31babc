#include "report/shared/conditions.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/operating_point.h"

namespace servodx::report {
namespace {

ConditionRow supply(double value, bool beyond) { return {Condition::supply, value, 207e5, 205e5, 208e5, beyond}; }

TEST(ConditionWords, SayWhatTheLogHoldsAndLeaveOutWhatItDoesNot) {
  const std::vector<ConditionRow> rows = {supply(206e5, false),
                                          {Condition::return_pressure, {}, 5e5, {}, {}, false},
                                          {Condition::oil, 314.15, {}, {}, {}, false}};
  EXPECT_EQ(conditions_in_words(rows), "supply 206 bar, oil 41 degC");
  EXPECT_EQ(beyond_in_words(rows), "");
}

TEST(ConditionWords, WhatIsBeyondStandsBesideTheLogsAndWithoutThemBesideTheSheet) {
  EXPECT_EQ(beyond_in_words({supply(140e5, true)}), "supply 140 bar (fault-free logs 205 bar to 208 bar)");
  ConditionRow alone = supply(140e5, true);
  alone.lowest = alone.highest = {};
  EXPECT_EQ(beyond_in_words({alone}), "supply 140 bar (sheet 207 bar)");
}

TEST(ConditionWords, TheLogsThatTunedStandBesideTheOthersInTextJsonAndPage) {
  ConditionRow row = supply(140e5, true), oil{Condition::oil, 314.15, {}, {}, {}, false};
  EXPECT_EQ(tuned_in_words({row, oil}), "");
  row.tuned_lowest = 206e5, row.tuned_highest = 209e5, oil.tuned_lowest = oil.tuned_highest = 313.15;
  EXPECT_EQ(tuned_in_words({row, oil}), "supply 206 bar to 209 bar, oil 40 degC");
  EXPECT_EQ(conditions_json({row})[0]["tuned_highest"], 209e5);
  EXPECT_TRUE(conditions_json({supply(140e5, true)})[0]["tuned_lowest"].is_null());
  const auto page_of = [](const std::vector<ConditionRow>& rows) {
    Page page({}, "a page");
    add_conditions(page, rows);
    return page.html();
  };
  for (const char* words : {"logs that tuned", "206 bar to 209 bar", "40 degC", "beyond"})
    EXPECT_NE(page_of({row, oil}).find(words), std::string::npos) << words;
  EXPECT_EQ(page_of({supply(140e5, true)}).find("logs that tuned"), std::string::npos);
  row.lowest = row.highest = {};
  EXPECT_EQ(beyond_in_words({row}), "supply 140 bar (tuning logs 206 bar to 209 bar)");
}

TEST(ConditionWords, JsonHoldsSiAndNullForWhatIsNotKnown) {
  const Json j = conditions_json({{Condition::load, 7e3, {}, {}, {}, false}});
  EXPECT_EQ(j[0]["condition"], "load_force");
  EXPECT_EQ(j[0]["unit"], "N");
  EXPECT_EQ(j[0]["value"], 7e3);
  EXPECT_TRUE(j[0]["sheet"].is_null());
  EXPECT_FALSE(j[0]["beyond"]);
}

}  // namespace
}  // namespace servodx::report
