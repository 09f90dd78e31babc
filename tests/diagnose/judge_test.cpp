// The verdict from assessments made by hand: no simulation here.
#include "diagnose/judge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/assessment.h"
#include "diagnose/baseline.h"
#include "diagnose/broken_sensors.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/healthy_law.h"
#include "diagnose/moved.h"
#include "diagnose/naming.h"
#include "evidence/conditions.h"
#include "faults/fault.h"
#include "faults/gross_finding.h"
#include "faults/registry.h"
#include "servodx/log.h"

namespace servodx {
namespace {

// No name: health.
HypothesisResult hypothesis(const std::string& name, double probability, double adequacy = 1.0) {
  HypothesisResult h;
  h.fault = find_fault(name);
  h.probability = probability;
  h.misfit = -2 * std::log(std::max(1e-30, probability) / (h.fault ? h.fault->prior : 1.0));
  h.adequacy = adequacy;
  h.severity = 0.6, h.severity_lower = 0.5, h.severity_upper = 0.7;
  return h;
}

Assessment assessment(double score, std::vector<HypothesisResult> hypotheses) {
  Assessment a;
  a.log = "log.csv";
  hypotheses.back().gain = score * score;
  a.hypotheses = std::move(hypotheses);
  return a;
}

// Scores 1, 2, 3 and so a threshold of 3.
DetectionBaseline baseline() {
  DetectionBaseline b;
  b.threshold = 3.0;
  b.adequacy_limit = 1.5;
  b.scores = {{"a", "1", 1.0, 1.2}, {"b", "2", 2.0, 1.5}, {"c", "3", 3.0, 1.0}};
  return b;
}

double probability_of(const Diagnosis& d, const std::string& fault) {
  for (const FaultProbability& p : d.probabilities)
    if (p.of == find_fault(fault)) return p.value;
  return -1;
}

TEST(Judge, ScoreAtTheThresholdIsHealthyWhateverTheHypothesesSay) {
  for (double score : {0.0, 2.9, 3.0}) {
    const Diagnosis d =
        judge(assessment(score, {hypothesis("", 0.01), hypothesis("clogged_filter", 0.99)}), baseline());
    EXPECT_EQ(d.verdict, VerdictKind::healthy) << score;
    EXPECT_FALSE(d.fault);
    EXPECT_EQ(d.error, score);
    EXPECT_EQ(d.threshold, 3.0);
  }
}

// Two logs of other tests speak in place of the baseline's own; how unlike health a log is they tell as well.
TEST(Judge, ALogFarFromHealthIsUnknownThoughOnlyTwoHealthyLogsAreOfItsTest) {
  DetectionBaseline b = baseline();
  b.scores.resize(2);
  Assessment a = assessment(0.1, {hypothesis("", 0.999), hypothesis("clogged_filter", 0.001)});
  a.hypotheses.front().adequacy = 1.3;
  EXPECT_EQ(judge(a, b).verdict, VerdictKind::healthy);
  for (HypothesisResult& h : a.hypotheses) h.adequacy = 140;
  EXPECT_EQ(judge(a, b).verdict, VerdictKind::unknown);
}

// Health and two faults by their misfits, with no error of the model beyond the usual.
Assessment with_misfits(double healthy, std::pair<const char*, double> one, std::pair<const char*, double> other) {
  Assessment a = assessment(0, {hypothesis("", 0.5), hypothesis(one.first, 0.5), hypothesis(other.first, 0.5)});
  const double misfits[] = {healthy, one.second, other.second};
  for (std::size_t i = 0; i < a.hypotheses.size(); ++i) {
    a.hypotheses[i].misfit = misfits[i];
    a.hypotheses[i].gain = healthy - misfits[i];
  }
  return a;
}

// Every healthy log gains so much by them.
DetectionBaseline baseline_with(const FaultGains& gains) {
  DetectionBaseline b = baseline();
  for (DetectionBaseline::Score& s : b.scores) s.gains = gains;
  return b;
}

// Blunt corners take up what the model's edges have wrong, on every log of this rig.
TEST(Judge, TheNameIsOfTheFaultThatGainsBeyondWhatItGainsOnHealthyLogs) {
  const Fault *corners = find_fault("corner_wear"), *filter = find_fault("clogged_filter");
  const Assessment a = with_misfits(217, {"corner_wear", 160}, {"clogged_filter", 193});
  EXPECT_EQ(judge(a, baseline()).fault, corners);
  const Diagnosis d = judge(a, baseline_with({{corners, 26.0}, {filter, 0.8}}));
  EXPECT_EQ(d.fault, filter);
  EXPECT_GT(probability_of(d, "clogged_filter"), 50 * probability_of(d, "corner_wear"));
}

TEST(Judge, OfALargeGainNoMoreIsTakenOffThanHealthLends) {
  const Fault *nozzle = find_fault("plugged_nozzle"), *motor = find_fault("torque_motor_loss");
  const Assessment a = with_misfits(3000, {"torque_motor_loss", 600}, {"plugged_nozzle", 400});
  EXPECT_EQ(judge(a, baseline_with({{nozzle, 1.0}, {motor, 0.1}})).fault, nozzle)
      << "half of its gain is no longer above the other's";
}

// A spool that sticks makes the simulation slew late, as does a filter that is all but closed.
TEST(Judge, AFaultAtTheEndOfItsRangeStandsBehindOneInsideThatTakesAsMuch) {
  const auto of = [](double left_by_sticky, bool filter_at_end, bool sticky_at_end) {
    Assessment a = with_misfits(3000, {"clogged_filter", 600}, {"sticky_spool", left_by_sticky});
    a.hypotheses[1].at_worst = filter_at_end, a.hypotheses[2].at_worst = sticky_at_end;
    return judge(a, baseline());
  };
  const Fault *filter = find_fault("clogged_filter"), *sticky = find_fault("sticky_spool");
  EXPECT_EQ(of(700, false, false).fault, filter);
  const Diagnosis d = of(700, true, false);
  EXPECT_EQ(d.fault, sticky) << "it takes 98 % of the amplitude";
  EXPECT_EQ(d.ambiguous_with, std::vector<const Fault*>{filter}) << "and the other is named beside it";
  EXPECT_EQ(of(1200, true, false).fault, filter) << "87 % is less than a model errs by";
  EXPECT_EQ(of(700, true, true).fault, filter) << "both are at their ends";
}

// A wire breaks and a nozzle is shut; a null goes as far as the search lets it.
TEST(Judge, AFaultThatIsWholeAtItsEndIsNamedThereAsInsideItsRange) {
  const auto at_end = [](const char* name, const char* other, double left_by_other) {
    Assessment a = with_misfits(3000, {name, 600}, {other, left_by_other});
    a.hypotheses[1].at_worst = true;
    a.hypotheses[1].adequacy = 80.0, a.hypotheses.front().adequacy = 400.0;
    return judge(a, baseline());
  };
  EXPECT_EQ(at_end("feedback_wire_lost", "sticky_spool", 2900).fault, find_fault("feedback_wire_lost"));
  EXPECT_EQ(at_end("null_shift", "sticky_spool", 2900).verdict, VerdictKind::unknown);
  EXPECT_EQ(at_end("plugged_nozzle", "null_shift", 1000).fault, find_fault("plugged_nozzle")) << "it is not put behind";
  EXPECT_EQ(at_end("clogged_filter", "null_shift", 700).fault, find_fault("null_shift"));
}

// A motor that is all but gone and a null of a fifth: both put the spool on its stop, and no simulation follows it
// there.
TEST(Judge, WhereTheBestLeavesMoreThanAFaultMayOneThatLeavesNearlyAsMuchIsNamedBesideIt) {
  const auto beside = [](double adequacy, double left_by_other) {
    Assessment a = with_misfits(100'000, {"torque_motor_loss", 5000}, {"null_shift", left_by_other});
    a.hypotheses.front().adequacy = 190, a.hypotheses[1].adequacy = adequacy, a.hypotheses[2].adequacy = 15;
    const Diagnosis d = judge(a, baseline());
    EXPECT_EQ(d.fault, find_fault("torque_motor_loss"));
    return std::ranges::count(d.ambiguous_with, find_fault("null_shift")) == 1;
  };
  EXPECT_TRUE(beside(12, 6000));
  EXPECT_FALSE(beside(12, 9000)) << "twenty times as unlikely, and more";
  EXPECT_FALSE(beside(2.5, 6000)) << "no more than the model is known to err by";
}

TEST(Judge, WornCornersAreNamedTogetherWithTheClearanceThatWearsWithThem) {
  const Diagnosis d = judge(assessment(9.0, {hypothesis("", 0.001), hypothesis("corner_wear", 0.999)}), baseline());
  EXPECT_EQ(d.fault, find_fault("corner_wear"));
  EXPECT_EQ(d.ambiguous_with, std::vector<const Fault*>{find_fault("radial_clearance_wear")});
}

// A lost motor alone leaves so much; with worn corners beside it as little as healthy logs leave.
Diagnosis beside_lost_motor(double left_alone) {
  Assessment a = assessment(10, {hypothesis("", 0.001, 20), hypothesis("corner_wear", 0.001, 9),
                                 hypothesis("torque_motor_loss", 0.998, left_alone)});
  PairResult pair;
  pair.first.fault = find_fault("torque_motor_loss"), pair.second.fault = find_fault("corner_wear");
  pair.gain = 16, pair.adequacy = 1.1;
  a.pairs = {pair};
  return judge(a, baseline());
}

TEST(Judge, BesideAFaultThatLeavesMoreThanAnyHealthyLogASecondHasToGainBeyondWhatBothLeave) {
  EXPECT_EQ(beside_lost_motor(1.4).faults.size(), 1u) << "4 deviates over 1.5 that healthy logs leave: below 3";
  EXPECT_EQ(beside_lost_motor(1.6).faults.size(), 2u) << "over 1.1";
}

TEST(Judge, OfTwoFaultsEachIsNamedTogetherWithItsTwin) {
  const Diagnosis d = beside_lost_motor(1.6);
  const auto& others = d.ambiguous_with;
  EXPECT_EQ(std::count(others.begin(), others.end(), find_fault("radial_clearance_wear")), 1);
}

TEST(Judge, ScoreAboveItNamesTheMostProbableFaultWithItsSize) {
  const Diagnosis d = judge(assessment(3.001, {hypothesis("", 0.001), hypothesis("sticky_spool", 0.001),
                                               hypothesis("clogged_filter", 0.998)}),
                            baseline());
  EXPECT_EQ(d.verdict, VerdictKind::fault);
  ASSERT_TRUE(d.fault);
  EXPECT_EQ(d.fault, find_fault("clogged_filter"));
  EXPECT_EQ(d.severity.value, 0.6);
  EXPECT_EQ(d.severity.lower, 0.5);
  EXPECT_EQ(d.severity.upper, 0.7);
  EXPECT_TRUE(d.ambiguous_with.empty());
  EXPECT_GT(probability_of(d, "clogged_filter"), 0.5) << "no probability contradicts the verdict";
}

TEST(Judge, NoProbabilityContradictsTheVerdict) {
  // Fits at odds of a thousand to one for a fault: under a healthy verdict health is the likelier all the same.
  for (double score = 0; score < 8; score += 0.25) {
    const Diagnosis d =
        judge(assessment(score, {hypothesis("", 0.001), hypothesis("clogged_filter", 0.999)}), baseline());
    const double healthy = d.probabilities.front().value;
    EXPECT_EQ(d.verdict == VerdictKind::healthy, healthy > 0.5) << score;
    EXPECT_NEAR(healthy + probability_of(d, "clogged_filter"), 1, 1e-12) << score;
  }
}

TEST(Judge, ALogSaysTheLeastOfEachFaultThatItWouldHaveShown) {
  // The limit is 3; 95 of 100 logs find a gain whose root is expected at 4.645.
  const double needed = 4.645 * 4.645;
  Assessment a = assessment(1.0, {hypothesis("", 0.9), hypothesis("clogged_filter", 0.1)});
  a.visible = {{find_fault("clogged_filter"), {{0.2, 0}, {0.4, needed}, {0.8, 4 * needed}}},
               {find_fault("sticky_spool"), {{4, 0}, {20, 0.9 * needed}}}};
  DetectionBaseline b = baseline();
  const Diagnosis d = judge(a, b);
  ASSERT_EQ(d.detectable.size(), 2u);
  EXPECT_NEAR(*d.detectable[0].severity, 0.4, 1e-3);
  EXPECT_FALSE(d.detectable[1].severity);
  // What healthy logs show of a fault hides it: three times the gain is asked for.
  for (DetectionBaseline::Score& s : b.scores) s.gains[find_fault("clogged_filter")] = 2;
  EXPECT_NEAR(*judge(a, b).detectable[0].severity, 0.4 + 0.4 * (std::sqrt(3.0) - 1), 1e-3);
}

TEST(Judge, WhatStandsFirstInAHealthyLogIsSaidWithItsRate) {
  const auto verdict = [](double score) {
    return judge(assessment(score, {hypothesis("", 0.1), hypothesis("clogged_filter", 0.9)}), baseline());
  };
  const Diagnosis near = verdict(2.9);
  ASSERT_EQ(near.verdict, VerdictKind::healthy);
  ASSERT_TRUE(near.suspicion);
  EXPECT_EQ(near.suspicion->fault, find_fault("clogged_filter"));
  EXPECT_EQ(near.suspicion->logs, 3);
  // One of three healthy logs shows as much: no rarer than two in four.
  EXPECT_GE(near.suspicion->rate, 0.5);
  EXPECT_FALSE(verdict(0.1).suspicion) << "healthy logs show as much more often than not";
  EXPECT_FALSE(verdict(5.0).suspicion) << "it is the verdict";
}

TEST(Judge, AHealthyLogThatTheModelDoesNotFollowSetsTheLimitOfTestsLikeItsOwnAlone) {
  DetectionBaseline b = baseline();
  const TestConditions slow{0.01, 1, {}}, fast{0.01, 100, {}};
  for (DetectionBaseline::Score& s : b.scores) s.test = slow;
  b.scores.push_back({"d", "4", 9.0, 5.0, {}, fast});
  ASSERT_FALSE(is_followed(b.scores.back().adequacy));
  Assessment a = assessment(6.0, {hypothesis("", 0.0, 4), hypothesis("clogged_filter", 1.0, 3)});
  a.test = slow;
  EXPECT_EQ(judge(a, b).verdict, VerdictKind::fault);
  EXPECT_EQ(judge(a, b).threshold, 3.0);
  a.test = fast;
  EXPECT_EQ(judge(a, b).verdict, VerdictKind::healthy);
  EXPECT_EQ(judge(a, b).threshold, 9.0);
  a.hypotheses.back().adequacy = 1;
  EXPECT_EQ(judge(a, b).threshold, 3.0) << "the model follows it with the fault";
}

TEST(Judge, AFaultThatHealthGainsByTooMustGainTheMore) {
  // Where fault-free logs gain 24 by a leaking cylinder, one that gains 100 by it is 2 deviates off, not 10.
  DetectionBaseline b = baseline();
  for (DetectionBaseline::Score& s : b.scores)
    s.gains = {{find_fault("cylinder_leakage"), 24.0}, {find_fault("sticky_spool"), 0.0}};
  const auto verdict = [&](const char* fault) {
    return judge(assessment(10.0, {hypothesis("", 0.0), hypothesis(fault, 1.0)}), b);
  };
  EXPECT_DOUBLE_EQ(verdict("cylinder_leakage").error, 2.0);
  EXPECT_EQ(verdict("cylinder_leakage").verdict, VerdictKind::healthy);
  EXPECT_DOUBLE_EQ(verdict("sticky_spool").error, 10.0);
  EXPECT_EQ(verdict("sticky_spool").verdict, VerdictKind::fault);
}

TEST(Judge, PValueIsTheRankAmongTheHealthyLogs) {
  // (1 + healthy logs at or above) / (n + 1)
  for (const auto& [score, p] : {std::pair{0.5, 1.0}, {1.5, 0.75}, {2.5, 0.5}, {3.0, 0.5}, {9.0, 0.25}})
    EXPECT_DOUBLE_EQ(
        judge(assessment(score, {hypothesis("", 1.0), hypothesis("clogged_filter", 0.0)}), baseline()).p_value, p)
        << score;
}

TEST(Judge, UnknownWhenTheBestHypothesisExplainsTooLittle) {
  // The best leaves as much as health does, ten times what healthy logs leave.
  const Diagnosis d =
      judge(assessment(20.0, {hypothesis("", 0.0, 15.0), hypothesis("clogged_filter", 1.0, 14.0)}), baseline());
  EXPECT_EQ(d.verdict, VerdictKind::unknown);
  EXPECT_FALSE(d.fault);
  EXPECT_EQ(probability_of(d, "clogged_filter"), 0.0);
}

TEST(Judge, FaultThatLeavesNoMoreThanHealthyLogsDoIsNamedHoweverLarge) {
  const Diagnosis d =
      judge(assessment(500.0, {hypothesis("", 0.0, 300.0), hypothesis("sticky_spool", 1.0, 1.5)}), baseline());
  EXPECT_EQ(d.verdict, VerdictKind::fault);
}

TEST(Judge, UnknownWhenHealthIsStillTheBestHypothesis) {
  const Diagnosis d =
      judge(assessment(5.0, {hypothesis("", 0.9, 4.0), hypothesis("sticky_spool", 0.1, 3.9)}), baseline());
  EXPECT_EQ(d.verdict, VerdictKind::unknown);
}

TEST(Judge, HypothesisThatCannotBeRuledOutIsListedWithTheTestThatSeparates) {
  const Diagnosis d =
      judge(assessment(9.0, {hypothesis("", 0.0), hypothesis("sticky_spool", 0.6),
                             hypothesis("feedback_wire_backlash", 0.39), hypothesis("null_shift", 0.01)}),
            baseline());
  EXPECT_EQ(d.fault, find_fault("sticky_spool"));
  EXPECT_EQ(d.ambiguous_with, std::vector<const Fault*>{find_fault("feedback_wire_backlash")});
}

TEST(Judge, SpoolOnBothStopsIsALostWireWhateverTheFitsSay) {
  Assessment a = assessment(1e3, {hypothesis("", 0.5, 80.0), hypothesis("torque_motor_loss", 0.5, 70.0),
                                  hypothesis("feedback_wire_lost", 0.0, 90.0)});
  a.gross = GrossFinding::spool_on_both_stops;
  const Diagnosis d = judge(a, baseline());
  EXPECT_EQ(d.verdict, VerdictKind::fault);
  EXPECT_EQ(d.fault, find_fault("feedback_wire_lost"));
  EXPECT_EQ(d.severity.value, 0.0);  // nothing left of it
  EXPECT_EQ(d.severity.lower, 0.0);
  EXPECT_EQ(probability_of(d, "feedback_wire_lost"), 1.0);
  EXPECT_EQ(probability_of(d, "torque_motor_loss"), 0.0);
  EXPECT_TRUE(d.ambiguous_with.empty());
}

TEST(Judge, OtherGrossFindingsNameNothingByThemselves) {
  for (const GrossFinding gross : {GrossFinding::spool_on_one_stop, GrossFinding::no_response}) {
    Assessment a = assessment(1e3, {hypothesis("", 0.5, 80.0), hypothesis("torque_motor_loss", 0.5, 70.0),
                                    hypothesis("feedback_wire_lost", 0.0, 90.0)});
    a.gross = gross;
    EXPECT_EQ(judge(a, baseline()).verdict, VerdictKind::unknown) << static_cast<int>(gross);
  }
}

TEST(Judge, RowsAndNullAreOfTheHypothesisThatTheVerdictIsOf) {
  HypothesisResult healthy = hypothesis("", 0.001), filter = hypothesis("clogged_filter", 0.998);
  healthy.null = 0.01, filter.null = 0.02;
  MovedRow row;
  row.name = "air";
  healthy.moved = {row};
  row.name = "filter_blockage_positive";
  filter.moved = {row};
  Assessment a = assessment(10, {healthy, filter});
  EXPECT_EQ(judge(a, baseline()).nearest, find_fault("clogged_filter"));
  EXPECT_EQ(judge(a, baseline()).null, 0.02);
  ASSERT_EQ(judge(a, baseline()).moved.size(), 1u);
  EXPECT_EQ(judge(a, baseline()).moved.front().name, "filter_blockage_positive");
  a.hypotheses.back().gain = 0;  // below the threshold the most probable fault is none
  EXPECT_EQ(judge(a, baseline()).nearest, nullptr);
  EXPECT_EQ(judge(a, baseline()).null, 0.01);
  EXPECT_EQ(judge(a, baseline()).moved.front().name, "air");
}

TEST(Judge, AmongSeveralLogsTheTestThatIsLeastKnownJudges) {
  DetectionBaseline b = baseline();
  const TestConditions known{0.020, 6.0, 313.0}, unknown{0.045, 6.0, 270.0};
  for (DetectionBaseline::Score& s : b.scores) s.test = known;
  Assessment a = assessment(1, {hypothesis("", 0.9), hypothesis("clogged_filter", 0.1)});
  for (const auto& tests : {std::vector{known, unknown}, std::vector{unknown, known}}) {
    a.tests = tests, a.test = tests.front();
    EXPECT_TRUE(judge(a, b).unlike);
  }
  a.tests = {known, known}, a.test = known;
  EXPECT_FALSE(judge(a, b).unlike);
}

// They judge a suspect of their test, so that it is known.
TEST(Judge, LogsOfOtherTestsCountAmongWhatIsKnownOfSeveralLogs) {
  DetectionBaseline b = baseline();
  const TestConditions known{0.020, 6.0, 313.0}, of_others{0.200, 600.0, 313.0}, unknown{0.045, 6.0, 270.0};
  for (DetectionBaseline::Score& s : b.scores) s.test = known;
  b.others = b.scores;
  for (DetectionBaseline::Score& s : b.others) s.test = of_others;
  Assessment a = assessment(1, {hypothesis("", 0.9), hypothesis("clogged_filter", 0.1)});
  a.tests = {of_others, unknown}, a.test = of_others;
  EXPECT_EQ(judge(a, b).assessment.test.drive_span, unknown.drive_span);
}

TEST(Judge, ATestUnlikeEveryLogOfTheBaselineIsSaidWithTheNearest) {
  DetectionBaseline b = baseline();
  const TestConditions warm{0.020, 6.0, 313.0}, cold{0.020, 6.0, 270.0}, large{0.045, 6.0, 313.0};
  Assessment a = assessment(1, {hypothesis("", 0.9), hypothesis("clogged_filter", 0.1)});
  a.test = warm;
  EXPECT_FALSE(judge(a, b).unlike) << "a baseline of earlier versions knows of no tests";
  b.scores[0].test = cold, b.scores[1].test = large, b.scores[2].test = TestConditions{0.018, 11.0, 320.0};
  EXPECT_FALSE(judge(a, b).unlike);
  b.scores[2].test = cold;  // now each is unlike in one thing: too cold, too large
  ASSERT_TRUE(judge(a, b).unlike);
  EXPECT_EQ(judge(a, b).unlike->log, "b");
  a.test.temperature.reset();  // a log that does not say is no other test
  EXPECT_FALSE(judge(a, b).unlike);
}

// Three repeats of one test, and two healthy logs of others: on a flight blunt corners gain on a healthy valve as well.
constexpr TestConditions acceptance{0.04, 20.0, {}, 0.01}, flight{0.004, 2.0, {}, 0.001}, sine{0.3, 2.0, {}, 0.1};
DetectionBaseline repeats_and_others() {
  const Fault* corners = find_fault("corner_wear");
  DetectionBaseline b = baseline();
  for (DetectionBaseline::Score& s : b.scores) s.test = acceptance, s.gains[corners] = 2.0;
  b.logs = 3;
  b.others = {{"flight", "4", 1.0, 1.0}, {"sine", "5", 0.5, 1.0}};
  b.others[0].test = flight, b.others[0].gains[corners] = 25.0;
  b.others[1].test = sine, b.others[1].gains[corners] = 0.0;
  return b;
}
Assessment of_corners(double gain, const TestConditions& test) {
  Assessment a = with_misfits(300, {"corner_wear", 300 - gain}, {"clogged_filter", 300});
  a.test = test;
  return a;
}

TEST(Judge, OfATestThatTheBaselineDoesNotHoldHealthyLogsOfOtherTestsSpeak) {
  const DetectionBaseline with = repeats_and_others();
  DetectionBaseline without = with;
  without.others.clear();
  EXPECT_EQ(judge(of_corners(60, flight), without).verdict, VerdictKind::fault);
  const Diagnosis d = judge(of_corners(60, flight), with);
  EXPECT_EQ(d.verdict, VerdictKind::healthy) << "a healthy flight shows nearly half of it";
  EXPECT_EQ(d.others, 1) << "the flight";
  EXPECT_EQ(judge(of_corners(2000, flight), with).fault, find_fault("corner_wear")) << "no healthy flight shows that";
}

// Logs of other tests promise no rate, so their number is no reason to ask for less than the rate.
TEST(Judge, LogsOfOtherTestsAreAskedForTheRateItself) {
  DetectionBaseline own = repeats_and_others();
  own.others.clear();
  own.of_other_tests = false, own.logs = 3;
  DetectionBaseline strange = own;
  strange.of_other_tests = true;
  const HealthyLaw promised(own, nullptr), asked(strange, nullptr);
  EXPECT_NEAR(promised.rate(), 0.8 / 4, 1e-12) << "one of four, as three logs promise";
  EXPECT_NEAR(asked.rate(), 0.8 * own.asked, 1e-12);
  EXPECT_GT(asked.limit(), promised.limit());
  EXPECT_LT(asked.error_of(0.0, 3.0) / asked.limit(), promised.error_of(0.0, 3.0) / promised.limit())
      << "nor is such a log so soon unlike health";
}

TEST(Judge, OfATestThatTheBaselineHoldsItsOwnLogsAloneSpeak) {
  const DetectionBaseline with = repeats_and_others();
  DetectionBaseline without = with;
  without.others.clear();
  const Diagnosis one = judge(of_corners(60, acceptance), with), other = judge(of_corners(60, acceptance), without);
  EXPECT_EQ(one.error, other.error);
  EXPECT_EQ(one.threshold, other.threshold);
  EXPECT_EQ(one.verdict, VerdictKind::fault);
  EXPECT_FALSE(one.unlike || one.others);
}

// Three repeats that show little, and a small test that shows much, in one baseline.
DetectionBaseline repeats_beside_another() {
  DetectionBaseline b = repeats_and_others();
  b.others.clear();
  b.scores.push_back({"small", "6", 6.0, 1.0});
  b.scores.back().test = sine, b.scores.back().gains[find_fault("corner_wear")] = 36.0;
  b.logs = 4;
  return b;
}

// Else the worst test of a baseline sets the limit of all of them, and a mild fault passes in the test that knows it.
TEST(Judge, ARepeatedTestIsJudgedByItsRepeatsAloneAndAnotherByAll) {
  const DetectionBaseline b = repeats_beside_another();
  const Diagnosis repeated = judge(of_corners(30, acceptance), b), other = judge(of_corners(30, sine), b);
  EXPECT_EQ(repeated.verdict, VerdictKind::fault);
  EXPECT_EQ(repeated.repeats, 3);
  EXPECT_EQ(other.verdict, VerdictKind::healthy);
  EXPECT_EQ(other.repeats, 0);
  EXPECT_EQ(judge(of_corners(4, acceptance), b).verdict, VerdictKind::healthy) << "hardly more than the repeats show";
}

TEST(BaselineFor, TwoRepeatsOrRepeatsThatTheModelDoesNotFollowAreNoNullOfTheirOwn) {
  DetectionBaseline b = repeats_beside_another();
  ASSERT_EQ(baseline_for(acceptance, b).scores.size(), 3u);
  b.scores[0].adequacy = 5.0;
  EXPECT_EQ(baseline_for(acceptance, b).scores.size(), 4u);
  b.scores[0].adequacy = 1.0, b.scores[0].test = flight;
  EXPECT_EQ(baseline_for(acceptance, b).scores.size(), 4u);
}

// Of like size and speed, and spending its time at other openings.
TEST(BaselineFor, RepeatsOfOneTestDoNotKnowAnotherLikeItAndSeveralTestsDo) {
  constexpr TestConditions similar{0.03, 30.0, {}, 0.004};
  DetectionBaseline b = repeats_and_others();
  EXPECT_EQ(baseline_for(similar, b).others.size(), 0u) << "the others speak";
  b.scores[1].test = similar, b.scores[1].test->drive_rms = 0.006;
  b.scores[2].test = sine;
  EXPECT_EQ(baseline_for(similar, b).others.size(), 2u) << "three tests, of which some are like it";
}

TEST(BaselineFor, WhereNoOtherIsOfSuchATestRepeatsCountAsOneLogBesideThem) {
  const TestConditions slow{0.04, 0.05, {}, 0.01};
  const DetectionBaseline speaking = baseline_for(slow, repeats_and_others());
  ASSERT_EQ(speaking.scores.size(), 3u);
  EXPECT_NEAR(usual_gains(speaking).at(find_fault("corner_wear")), (25.0 + 0.0 + 2.0) / 3, 1e-12);
  DetectionBaseline two = repeats_and_others();
  two.scores[2].test = sine;
  EXPECT_EQ(baseline_for(slow, two).scores.size(), 4u) << "two programmes of its own are two logs";
  EXPECT_TRUE(speaking.of_other_tests);
  EXPECT_EQ(baseline_for(slow, repeats_and_others(), 0).scores.size(), 2u);
}

// The fits of a log whose sensors are wrong are of no valve.
TEST(Judge, OfABrokenSensorNoOnsetAndNoRowIsTheValves) {
  Assessment a = assessment(9.0, {hypothesis("", 0.0), hypothesis("sticky_spool", 1.0)});
  a.hypotheses.back().moved = {MovedRow{}};
  a.onset = 2.0;
  ASSERT_FALSE(judge(a, baseline()).moved.empty());
  for (const SensorFinding finding : {SensorFinding::turned, SensorFinding::swapped_ports, SensorFinding::frozen}) {
    a.broken = {{finding, Signal::pressure_a}};
    const Diagnosis d = judge(a, baseline());
    EXPECT_EQ(d.fault, find_fault("sensor_fault"));
    EXPECT_TRUE(d.moved.empty() && d.detectable.empty());
    EXPECT_FALSE(d.onset);
  }
}

TEST(Judge, OnsetIsHandedOn) {
  Assessment a = assessment(9.0, {hypothesis("", 0.0), hypothesis("sticky_spool", 1.0)});
  a.onset = 1.25;
  EXPECT_EQ(judge(a, baseline()).onset, 1.25);
}

}  // namespace
}  // namespace servodx
