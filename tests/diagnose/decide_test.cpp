// The rules of the verdict on made-up evidence, a row a case: no fit, no log, no registry.
#include "diagnose/decide.h"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "diagnose/judgeable.h"
#include "faults/fault.h"
#include "faults/record.h"

namespace servodx {
namespace {

using enum GrossFinding;

// Faults of no registry: the rules know them by what they state of themselves alone.
Fault some_fault(std::string_view name, std::optional<SeenOutright> outright = {}) {
  return {.name = name,
          .meaning = "",
          .unit = "",
          .healthy = 0,
          .worst = 1,
          .log_scale = false,
          .least = 0.1,
          .spread = 0,
          .starts = {},
          .test = "",
          .action = "",
          .apply = nullptr,
          .seen_outright = outright};
}

const Fault first = some_fault("first"), second = some_fault("second");
const Fault runs_away = some_fault("runs away", SeenOutright{spool_on_both_stops, 0.1});

constexpr std::size_t health = 0, one = 1, other = 2, away = 3;  // in the evidence

struct Case {
  std::string name;
  double error;  // the threshold is 3
  GrossFinding gross;
  std::array<double, 4> probability, adequacy;  // of health, first, second, runs away
  VerdictKind verdict;
  std::size_t hypothesis;
  std::vector<std::size_t> ambiguous;
  SeveritySource severity;
};

Evidence evidence_of(const Case& c) {
  Evidence e;
  e.error = e.gain = c.error;
  e.threshold = 3;
  e.usual_adequacy = 1.5;  // so a fault may leave hypot(3, a quarter of what health leaves)
  e.gross = c.gross;
  const Fault* faults[] = {nullptr, &first, &second, &runs_away};
  for (std::size_t i = 0; i < 4; ++i) e.hypotheses.push_back({faults[i], c.probability[i], c.adequacy[i]});
  return e;
}

const std::vector<Case> cases = {
    {"at the threshold, whatever the hypotheses say",
     3.0,
     none,
     {0.0, 1.0, 0.0, 0.0},
     {8, 1, 9, 9},
     VerdictKind::healthy,
     health,
     {},
     SeveritySource::none},
    {"just above it",
     3.0001,
     none,
     {0.0, 1.0, 0.0, 0.0},
     {8, 1, 9, 9},
     VerdictKind::fault,
     one,
     {},
     SeveritySource::fit},
    {"health most probable and yet above",
     5,
     none,
     {0.9, 0.1, 0.0, 0.0},
     {4, 3.9, 9, 9},
     VerdictKind::unknown,
     health,
     {},
     SeveritySource::none},
    {"the best just enough: 5 of hypot(3, 16 / 4)",
     9,
     none,
     {0.0, 1.0, 0.0, 0.0},
     {16, 5, 9, 9},
     VerdictKind::fault,
     one,
     {},
     SeveritySource::fit},
    {"the best leaves too much",
     9,
     none,
     {0.0, 1.0, 0.0, 0.0},
     {16, 5.001, 9, 9},
     VerdictKind::unknown,
     one,
     {},
     SeveritySource::none},
    {"a less probable one that fits is not taken for the best",
     9,
     none,
     {0.0, 0.6, 0.4, 0.0},
     {16, 6, 1, 9},
     VerdictKind::unknown,
     one,
     {},
     SeveritySource::none},
    {"a pair that cannot be told apart",
     9,
     none,
     {0.0, 0.39, 0.6, 0.01},
     {16, 2, 1, 9},
     VerdictKind::fault,
     other,
     {one},
     SeveritySource::fit},
    {"at the probability from which one is ambiguous",
     9,
     none,
     {0.0, 0.95, 0.05, 0.0},
     {16, 1, 1, 9},
     VerdictKind::fault,
     one,
     {},
     SeveritySource::fit},
    {"health among what cannot be ruled out",
     9,
     none,
     {0.3, 0.7, 0.0, 0.0},
     {4, 1, 1, 9},
     VerdictKind::fault,
     one,
     {health},
     SeveritySource::fit},
    {"seen outright, whatever the fits say",
     1e3,
     spool_on_both_stops,
     {0.5, 0.5, 0.0, 0.0},
     {80, 1, 9, 90},
     VerdictKind::fault,
     away,
     {},
     SeveritySource::seen_outright},
    {"seen outright, but the threshold is higher still",
     2,
     spool_on_both_stops,
     {0.5, 0.5, 0.0, 0.0},
     {80, 1, 9, 90},
     VerdictKind::healthy,
     health,
     {},
     SeveritySource::none},
    {"a finding that names nothing leaves it to the fits: none fits",
     1e3,
     spool_on_one_stop,
     {0.4, 0.6, 0.0, 0.0},
     {8, 70, 9, 9},
     VerdictKind::unknown,
     one,
     {},
     SeveritySource::none},
    {"a finding that names nothing leaves it to the fits: one fits",
     1e3,
     no_response,
     {0.0, 1.0, 0.0, 0.0},
     {80, 1, 9, 9},
     VerdictKind::fault,
     one,
     {},
     SeveritySource::fit},
};

TEST(Decide, EachCaseOfTheTable) {
  for (const Case& c : cases) {
    const Decision d = decide(evidence_of(c));
    EXPECT_EQ(d.verdict, c.verdict) << c.name;
    EXPECT_EQ(d.hypothesis, c.hypothesis) << c.name;
    EXPECT_EQ(d.ambiguous, c.ambiguous) << c.name;
    EXPECT_EQ(d.severity, c.severity) << c.name;
  }
}

TEST(Decide, AFaultThatStandsFirstInAHealthyLogIsSuspectedWhereItGains) {
  Evidence e;
  e.error = 2, e.threshold = 3;
  e.hypotheses = {{nullptr, 0.2, 1}, {&first, 0.7, 1}, {&second, 0.1, 1}};
  EXPECT_EQ(decide(e).suspected, std::nullopt) << "it gains nothing";
  e.hypotheses[1].gain = 4;
  EXPECT_EQ(decide(e).suspected, one);
  e.hypotheses[0].probability = 0.8;
  EXPECT_EQ(decide(e).suspected, std::nullopt) << "health stands first";
  e.hypotheses[0].probability = 0.2, e.error = 4;
  EXPECT_EQ(decide(e).suspected, std::nullopt) << "it is the verdict";
}

TEST(Decide, AFaultIsNotNamedForWhatNoFaultExplains) {
  Evidence e;
  e.error = 9, e.threshold = 3, e.usual_adequacy = 1.5;
  e.hypotheses = {{nullptr, 0.3, 3}, {&first, 0.7, 2.9}};
  e.gain = 0.8;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown) << "unlike health, and the fault gains nothing";
  e.gain = 3.1;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
}

TEST(Decide, ASizeAtTheEndOfItsRangeIsHeldToHealthsMeasure) {
  Evidence e;
  e.error = e.gain = 9, e.threshold = 3, e.usual_adequacy = 1.5;
  e.hypotheses = {{nullptr, 0, 40}, {&first, 1, 9}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault) << "9 of hypot(3, 40 / 4)";
  e.hypotheses[1].at_worst = true;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
  e.hypotheses[1].adequacy = 3;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
}

TEST(Decide, OfATestThatTheBaselineDoesNotHoldAFaultHasToTakeMost) {
  Evidence e;
  e.error = e.gain = 9, e.threshold = 3, e.usual_adequacy = 1.5;
  const auto named = [&](double by_health, double by_fault) {
    e.hypotheses = {{nullptr, 0, by_health}, {&first, 1, by_fault}};
    return decide(e).verdict == VerdictKind::fault;
  };
  EXPECT_TRUE(named(3.5, 2.6)) << "below hypot(3, 3.5 / 4)";
  e.known_test = false;
  EXPECT_FALSE(named(3.5, 2.6)) << "above hypot(1.5, 3.5 / 2): it leaves more than it takes";
  EXPECT_TRUE(named(3.5, 2.2));
  EXPECT_FALSE(named(20, 6)) << "above hypot(3, 20 / 4), as of any test";
}

TEST(Decide, ProbabilitiesAreTheFitsUnlessOneIsSeenOrNoneHolds) {
  for (const Case& c : cases) {
    const Decision d = decide(evidence_of(c));
    for (std::size_t i = 0; i < 4; ++i) {
      const double expected = d.verdict == VerdictKind::unknown             ? 0.0
                              : d.severity == SeveritySource::seen_outright ? (i == d.hypothesis ? 1.0 : 0.0)
                                                                            : c.probability[i];
      EXPECT_EQ(d.probabilities[i], expected) << c.name << ", " << i;
    }
  }
}

// Health 0.01, the first fault 0.98: beyond the threshold, and explained.
Evidence first_fault() {
  Evidence e;
  e.error = e.gain = 10, e.threshold = 3, e.usual_adequacy = 1.5;
  e.hypotheses = {{nullptr, 0.01, 8}, {&first, 0.98, 2}, {&second, 0.01, 6}, {&runs_away, 0.0, 8}};
  return e;
}
PairEvidence a_pair(double gain) { return {one, other, gain, 1.2, false, false}; }

TEST(Decide, ASecondFaultIsNamedOnlyWithAGainOfItsOwn) {
  Evidence e = first_fault();
  for (const double gain : {0.0, 2.9, 3.0}) {
    e.pair = a_pair(gain);
    EXPECT_FALSE(decide(e).beside) << gain;
    EXPECT_EQ(decide(e).hypothesis, one);
  }
  e.pair = a_pair(3.1);
  const Decision d = decide(e);
  EXPECT_EQ(d.verdict, VerdictKind::fault);
  EXPECT_EQ(d.hypothesis, one);
  EXPECT_EQ(d.beside, other);
}

TEST(Decide, APairNamesWhatNoSingleFaultExplains) {
  Evidence e = first_fault();
  e.hypotheses[one].adequacy = e.hypotheses[other].adequacy = 7;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
  e.pair = a_pair(5);
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
  EXPECT_EQ(decide(e).beside, other);
}

TEST(Decide, NoPairInHealthNorWhereOneOfThemIsNotFoundNorWhereTheyLeaveMuch) {
  Evidence healthy = first_fault();
  healthy.pair = a_pair(5);
  healthy.error = healthy.gain = 2;
  EXPECT_EQ(decide(healthy).verdict, VerdictKind::healthy);
  Evidence not_found = first_fault();
  not_found.pair = a_pair(5), not_found.pair->at_least = true;
  EXPECT_FALSE(decide(not_found).beside);
  Evidence much_left = first_fault();
  much_left.pair = a_pair(5), much_left.pair->adequacy = 7;
  EXPECT_FALSE(decide(much_left).beside);
}

TEST(Decide, WhereNoCurrentFollowsTheCommandTheDriverIsNamedThoughTheValveIsAskedNothing) {
  Evidence e;
  e.unjudgeable = Unjudgeable::nothing_asked;
  e.hypotheses = {{nullptr, 0, 1e3}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
  e.records = {{Record::supply, false}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown) << "a supply does not keep the command still";
  e.records = {{Record::driver, false}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
  EXPECT_EQ(decide(e).record, 0u);
  EXPECT_EQ(decide(e).doubt, Doubt::none);
  e.unjudgeable = Unjudgeable::noise_alone;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
}

TEST(Decide, AnUnusualSupplyOrDriverIsNamedAndAFaultOfTheValveStandsBesideIt) {
  for (const Record of : {Record::supply, Record::driver}) {
    Evidence healthy = first_fault();
    healthy.error = healthy.gain = 2;
    healthy.records = {{of}};
    Decision d = decide(healthy);
    EXPECT_EQ(d.verdict, VerdictKind::fault);
    EXPECT_EQ(d.record, 0u);
    EXPECT_FALSE(d.valve_too);
    Evidence both = first_fault();
    both.records = {{of}};
    d = decide(both);
    EXPECT_EQ(d.record, 0u);
    EXPECT_TRUE(d.valve_too);
    EXPECT_EQ(d.hypothesis, one);
  }
}

// The record drives the simulation: another rig's log under another supply is no supply's fault.
TEST(Decide, AnUnusualSupplyIsNotNamedWhereTheLogIsUnlikeHealthWithIt) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.adequacy = 50, h.gain = 0;
  e.gain = 0;
  e.records = {{Record::supply}};
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
  EXPECT_FALSE(decide(e).record);
  e.hypotheses.front().adequacy = 1.9 * e.usual_adequacy;
  EXPECT_EQ(decide(e).record, 0u) << "within what a fault may leave";
}

TEST(Decide, ANoisySensorGivesWayToAFaultOfTheValve) {
  Evidence e = first_fault();
  e.records = {{Record::sensor}};
  EXPECT_FALSE(decide(e).record);
  e.error = e.gain = 2;
  EXPECT_EQ(decide(e).record, 0u);
}

TEST(Decide, ABrokenSensorIsNamedAlone) {
  Evidence e = first_fault();
  e.records = {{Record::sensor, true}};
  const Decision d = decide(e);
  EXPECT_EQ(d.record, 0u);
  EXPECT_FALSE(d.valve_too);
}

TEST(Decide, ABrokenSensorIsNotNamedWhereTheOthersDoNotMoveAsTheValveWould) {
  Evidence e = first_fault();
  e.records = {{Record::sensor, true}};
  e.others_left = 0.9;
  EXPECT_FALSE(decide(e).record);
  e.error = e.gain = 90;
  for (HypothesisEvidence& h : e.hypotheses) h.adequacy = 50;
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown) << "nor as a noisy one";
}

// A fault over 99 %, and a reading of the log under which a healthy valve leaves a twentieth of it.
TEST(Decide, AMistakeAboutTheLogGoesBeforeAFaultThatLeavesMore) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.4;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
  EXPECT_EQ(decide(e).doubt, Doubt::none);
  e.reading = {.motion_left = 0.02};
  EXPECT_EQ(decide(e).verdict, VerdictKind::unknown);
  EXPECT_EQ(decide(e).doubt, Doubt::misread);
  e.hypotheses[other].motion_left = 0.03;
  EXPECT_EQ(decide(e).doubt, Doubt::misread) << "what is not named explains nothing";
  e.hypotheses[one].motion_left = 0.03;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault) << "the fault explains the log as it was read";
  e.hypotheses[one].motion_left = 0.9, e.reading->motion_left = 0.4;
  EXPECT_NE(decide(e).doubt, Doubt::misread) << "no reading explains it";
}

// A frozen sensor: the rest of the log moves as a healthy valve's, and at half its time some of it still does.
TEST(Decide, NoMistakeIsToldOfALogThatMovesAsAHealthyValves) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.6;
  e.records = {{Record::sensor, true}};
  e.others_left = 0.03;
  e.reading = {.motion_left = 0.12};
  EXPECT_EQ(decide(e).doubt, Doubt::misread);
  e.hypotheses.front().motion_left = 0.04;
  EXPECT_NE(decide(e).doubt, Doubt::misread);
  EXPECT_TRUE(decide(e).record);
}

TEST(Decide, AHealthyLogOfWhichLittleIsLeftIsReadWellEnough) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.03;
  e.reading = {.motion_left = 0.005};
  EXPECT_EQ(decide(e).doubt, Doubt::misread);
  e.error = e.gain = 1;
  EXPECT_EQ(decide(e).verdict, VerdictKind::healthy);
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.2;
  EXPECT_EQ(decide(e).doubt, Doubt::misread);
}

TEST(Decide, AMistakeAboutTheLogGoesBeforeHealthAndARecord) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.4;
  e.error = e.gain = 1;
  EXPECT_EQ(decide(e).verdict, VerdictKind::healthy);
  e.records = {{Record::sensor, true}};
  e.reading = {.motion_left = 0.02, .of_a_sensor = true};
  EXPECT_EQ(decide(e).record, 0u) << "the same, said of the sensor";
  e.reading->of_a_sensor = false;
  EXPECT_EQ(decide(e).doubt, Doubt::misread);
  EXPECT_FALSE(decide(e).record);
}

TEST(Decide, WhereNoHypothesisMovesAsTheLogDoesNoneIsNamed) {
  Evidence e = first_fault();
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.9;
  EXPECT_EQ(decide(e).doubt, Doubt::unrelated);
  e.hypotheses[other].motion_left = 0.1;
  EXPECT_EQ(decide(e).doubt, Doubt::unrelated) << "it is another fault that does";
  e.hypotheses[one].motion_left = 0.1;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault);
  for (HypothesisEvidence& h : e.hypotheses) h.motion_left = 0.9;
  e.error = e.gain = 1;
  EXPECT_EQ(decide(e).doubt, Doubt::unrelated) << "nor is it healthy";
  e.error = e.gain = 90, e.gross = spool_on_both_stops;
  EXPECT_EQ(decide(e).verdict, VerdictKind::fault) << "seen without a simulation";
}

TEST(Decide, ASpoolOnItsStopsIsNoSupplysFault) {
  Evidence e = first_fault();
  e.gross = spool_on_both_stops;
  e.records = {{Record::supply}};
  const Decision d = decide(e);
  EXPECT_EQ(d.hypothesis, away);
  EXPECT_FALSE(d.record);
}

}  // namespace
}  // namespace servodx
