// A verdict read back: its words as types, and what two of them are compared by.
#include "store/verdict_file.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "diagnose/decide.h"
#include "diagnose/test_change.h"

namespace servodx::store {
namespace {

using Json = nlohmann::ordered_json;

TestSide side(const Json& verdict, const Json& fault = nullptr, double lower = 0, double upper = 0) {
  Json one = {{"verdict", verdict}, {"fault", fault}};
  if (upper > 0) one["severity"] = {{"value", lower}, {"lower", lower}, {"upper", upper}, {"unit", "m"}};
  return verdict_of({{"command", "diagnose"}, {"results", Json::array({one})}}).side;
}

TEST(StoredVerdict, ItsWordIsATypeAndAnotherWordIsKept) {
  struct Case {
    Json word;
    std::optional<VerdictKind> verdict;
    std::string other;
  };
  for (const Case& c : {Case{"healthy", VerdictKind::healthy, ""}, Case{"fault", VerdictKind::fault, ""},
                        Case{"unknown", VerdictKind::unknown, ""}, Case{"of_a_later_version", {}, "of_a_later_version"},
                        Case{nullptr, {}, ""}}) {
    const TestSide read = side(c.word);
    EXPECT_EQ(read.verdict, c.verdict) << c.word;
    EXPECT_EQ(read.other_verdict, c.other) << c.word;
    EXPECT_EQ(read.healthy(), c.verdict == VerdictKind::healthy) << c.word;
  }
}

TEST(StoredVerdict, FindingsAreTheSameByTheFaultOrElseByTheVerdict) {
  const std::string backlash = "feedback_wire_backlash", loss = "torque_motor_loss", gone = "fault_of_an_older_version";
  EXPECT_TRUE(findings_of(side("healthy"), side("healthy")).same);
  EXPECT_FALSE(findings_of(side("healthy"), side("unknown")).same);
  EXPECT_FALSE(findings_of(side("unknown"), side("fault", backlash)).same);
  EXPECT_TRUE(findings_of(side("fault", loss), side("fault", loss)).same);
  EXPECT_FALSE(findings_of(side("fault", loss), side("fault", backlash)).same);
  EXPECT_TRUE(findings_of(side("fault", gone), side("fault", gone)).same);
  EXPECT_FALSE(findings_of(side("fault", gone), side("fault", loss)).same);
  EXPECT_FALSE(findings_of(side("a"), side("b")).same);
}

TEST(StoredVerdict, SizesComeWithTheirIntervalsAndTheWayTheyGetWorse) {
  const TwoFindings two = findings_of(side("fault", "torque_motor_loss", 0.6, 0.7), side("healthy"));
  ASSERT_TRUE(two.last.size.has_value());
  EXPECT_EQ(two.last.size->lower, 0.6);
  EXPECT_EQ(two.last.size->upper, 0.7);
  EXPECT_FALSE(two.last.healthy);
  EXPECT_TRUE(two.now.healthy);
  EXPECT_FALSE(two.now.size.has_value());
  const auto worse_upwards = [](const char* fault) {
    return findings_of(side("fault", fault), side("fault", fault)).worse_upwards;
  };
  EXPECT_TRUE(worse_upwards("feedback_wire_backlash"));
  EXPECT_FALSE(worse_upwards("torque_motor_loss"));  // of what is left
  EXPECT_TRUE(worse_upwards("fault_of_an_older_version"));
}

}  // namespace
}  // namespace servodx::store
