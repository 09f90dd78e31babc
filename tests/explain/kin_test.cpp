// Which healthy logs speak of a suspect's test.
#include "explain/kin.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "evidence/conditions.h"
#include "explain/healthy.h"
#include "explain/inquiry.h"
#include "explain/missing_support.h"
#include "fit/own_air.h"
#include "servodx/explain.h"
#include "servodx/log.h"

namespace servodx {
namespace {

TestConditions test(double span, double rms, double band = 10, double celsius = 40) {
  return {span, band, celsius + 273.15, rms};
}

HealthyReference reference(const std::vector<TestConditions>& tests) {
  HealthyReference r;
  for (const TestConditions& t : tests) {
    r.logs.emplace_back();
    r.logs.back().log = std::to_string(r.logs.size());
    r.logs.back().test = t;
  }
  return r;
}

const std::vector<TestConditions> twelve(12, test(40e-3, 8e-3));

TEST(Kin, RepeatsOfTheSuspectsTestSpeakAlone) {
  auto tests = twelve;
  tests.push_back(test(5e-3, 1e-3));
  const SpeakingLogs s = logs_that_speak(reference(tests), {test(41e-3, 8.2e-3)});
  EXPECT_EQ(s.logs.logs.size(), 12u);
  EXPECT_TRUE(s.alike);
}

TEST(Kin, RepeatsOfAnotherTestSpeakAsOneLog) {
  const SpeakingLogs s = logs_that_speak(reference(twelve), {test(40e-3, 11e-3)});
  EXPECT_EQ(s.logs.logs.size(), 1u);
  EXPECT_FALSE(s.alike);
}

TEST(Kin, FewOfTheSuspectsTestAreJoinedByOneOfEveryOther) {
  const SpeakingLogs s = logs_that_speak(
      reference({test(40e-3, 8e-3), test(5e-3, 1e-3), test(5e-3, 1e-3), test(20e-3, 4e-3), test(40e-3, 8e-3)}),
      {test(40e-3, 8e-3)});
  EXPECT_EQ(s.logs.logs.size(), 4u);
  EXPECT_TRUE(s.alike);
}

// Steps of some per cent that the model has wrong say nothing of a flight that it follows, and all of such steps.
TEST(Kin, ALogThatTheModelDoesNotFollowSetsNoShareOfTestsThatItFollows) {
  const TestConditions large = test(40e-3, 8e-3), small = test(5e-3, 1e-3), fast = test(20e-3, 4e-3, 100);
  HealthyReference all = reference({large, small, fast, test(20e-3, 6e-3)});
  const auto silent = [&](const std::vector<TestConditions>& suspects) {
    const HealthyReference marked = shares_marked(all, suspects, false);
    EXPECT_EQ(marked.logs.size(), 4u);
    EXPECT_EQ(marked.promising(), 4) << "a promise rests on all";
    return std::count_if(marked.logs.begin(), marked.logs.end(), [](const auto& log) { return log.sets_no_share; });
  };
  EXPECT_EQ(silent({large}), 0);
  all.logs[1].adequacy = 16;
  EXPECT_EQ(silent({large}), 1);
  EXPECT_EQ(silent({small}), 0) << "of its own test it speaks";
  EXPECT_EQ(silent({large, small}), 0);
  EXPECT_EQ(silent({test(40e-3, 8e-3, 10, -25)}), 0) << "no healthy log is as cold";
  all.logs[1].adequacy = 3.9;
  EXPECT_EQ(silent({large}), 0) << "less than twice as wrong";
}

TEST(Kin, ALogWhoseFitTakesAllTheAirThatItMaySetsNoShareOfLogsThatFindTheirs) {
  HealthyReference all = reference({test(40e-3, 8e-3), test(5e-3, 1e-3)});
  all.logs[0].air = 0.02, all.logs[1].air = most_own_air;
  const auto silent = [&](bool suspects_take_all) {
    std::vector<bool> out;
    for (const HealthyLog& log : shares_marked(all, {test(40e-3, 8e-3)}, suspects_take_all).logs)
      out.push_back(log.sets_no_share);
    return out;
  };
  EXPECT_EQ(silent(false), (std::vector<bool>{false, true}));
  EXPECT_EQ(silent(true), (std::vector<bool>{false, false}));
}

TEST(Kin, ASuspectThatFindsItsAirIsJudgedBesideLogsThatFindTheirs) {
  const Rehearsed r("healthy/h12_mixed", {},
                    {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b}, 11);
  HealthyReference healthy = reference(std::vector(5, conditions_of(r.log)));
  for (HealthyLog& log : healthy.logs) log.has_shares = true, log.air = 0.004;
  healthy.logs.front().air = most_own_air;
  const ExplainOptions options;
  const Inquiry inquiry({r.log}, r.table, r.rig, &healthy, options);
  EXPECT_EQ(inquiry.test()->shares().logs(), 4);
}

TEST(Kin, RepeatsAreOneProgrammeWhateverTheirOil) {
  const TestConditions cold = test(40e-3, 8e-3, 10, 0), warm = test(41e-3, 8.2e-3, 10, 60), other = test(40e-3, 11e-3);
  EXPECT_FALSE(is_repeat(cold, warm));
  EXPECT_EQ(programmes_of({cold, warm, other, cold}), (std::vector<std::size_t>{0, 0, 1, 0}));
  EXPECT_FALSE(show_scatter_of_tests({}));
  EXPECT_FALSE(show_scatter_of_tests({cold, warm, test(40e-3, 8e-3, 10, 30)})) << "one acceptance test, -10 to 60 degC";
  EXPECT_TRUE(show_scatter_of_tests({cold, other, test(80e-3, 8e-3)}));
}

TEST(Kin, OtherOilIsAnotherTest) { EXPECT_FALSE(logs_that_speak(reference(twelve), {test(40e-3, 8e-3, 10, 0)}).alike); }

TEST(Kin, AReferenceThatDoesNotSayItsTestsSpeaksWhole) {
  auto tests = twelve;
  tests.back().drive_rms = 0;
  EXPECT_EQ(logs_that_speak(reference(tests), {test(1e-3, 1e-4)}).logs.logs.size(), 12u);
}

}  // namespace
}  // namespace servodx
