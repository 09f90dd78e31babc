// Levels, alerts, causes and resets, on made-up histories.
#include "prognose/trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "model/state.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/tangent_rule.h"
#include "prognose/track.h"
#include "prognose/trend_options.h"
#include "prognose/trend_state.h"
#include "prognose/valve_history.h"
#include "servodx/maintenance.h"
#include "servodx/note.h"

namespace servodx {
namespace {

// A check every 2 h: backlash grows from `onset` h on to 20 um at 120 h, r stays, oil is anything.
ValveHistory a_life(double until, double onset, std::uint64_t seed, double growth = 20e-6) {
  ValveHistory h;
  h.valve = "v";
  Random random(seed, 6);
  for (double t = 0; t <= until; t += 2) {
    Recording r;
    r.at = t;
    r.table_sha256 = "a";
    r.temperature = 243 + 100 * random.uniform();
    const double cold = std::max(0.0, 313 - r.temperature) / 70;
    const double play = t > onset ? growth * (t - onset) / (120 - onset) : 0.0;
    r.checks.push_back(
        {"parameter:9", 1e-6 + play + 3e-7 * random.normal(), 2e-7, "m", 0, 1, "feedback_wire_backlash"});
    const double fidelity = 1.1 * (1 + 0.1 * cold) * (1 + 0.01 * random.normal());
    const double expected = 1 + 0.1 * cold;
    r.checks.push_back({"fidelity", fidelity / expected, 0.005 / expected, "1", fidelity, expected, ""});
    h.recordings.push_back(r);
  }
  return h;
}

const CheckTrend& find(const ValveTrend& t, const CheckName& name) {
  for (const CheckTrend& c : t.trends)
    if (c.name == name) return c;
  throw std::runtime_error("no " + name.text());
}

TEST(Trend, AHealthyValveHasNoTrendAndNoAlert) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const ValveTrend t = trend(a_life(100, 1e9, seed), {});
    EXPECT_FALSE(t.alert_at) << seed;
    EXPECT_FALSE(t.remaining) << seed;
    for (const CheckTrend& c : t.trends) EXPECT_FALSE(c.trend) << c.name.text() << " " << seed;
  }
}

TEST(Trend, AWearingValveIsAlertedNamedAndGivenItsLife) {
  const ValveTrend t = trend(a_life(80, 24, 1), {});
  EXPECT_EQ(t.state, TrendState::warning);
  EXPECT_EQ(t.cause, "feedback_wire_backlash");
  ASSERT_TRUE(t.alert_at);
  EXPECT_GT(*t.alert_at, 24);
  EXPECT_LT(*t.alert_at, 50);
  ASSERT_TRUE(t.remaining);
  EXPECT_LE(t.remaining->lower, 40);
  EXPECT_GE(t.remaining->upper, 40);
  EXPECT_NEAR(t.remaining->median, 40, 12);
  EXPECT_EQ(t.to_warning, 0.0);
  const CheckTrend& c = find(t, "parameter:9");
  EXPECT_NEAR(c.slope, 20e-6 / 96, 5e-8);
  ASSERT_TRUE(c.tangent);
  EXPECT_FALSE(find(t, "fidelity").trend);
}

TEST(Trend, AColdPreflightIsNoAlarm) {
  ValveHistory h = a_life(60, 1e9, 4);
  h.recordings.back().temperature = 243;
  h.recordings.back().checks[1].measured = 1.1 * 1.1;
  h.recordings.back().checks[1].value = h.recordings.back().checks[1].measured / h.recordings.back().checks[1].expected;
  const ValveTrend t = trend(h, {});
  const CheckTrend& c = find(t, "fidelity");
  EXPECT_NE(c.state, TrendState::warning);
  EXPECT_NEAR(c.points.back().value, c.healthy, 0.03 * c.healthy);
}

TEST(Trend, TooFewChecksGiveNoWord) {
  const ValveTrend t = trend(a_life(6, 0, 1), {});
  EXPECT_EQ(t.state, TrendState::unknown);
  EXPECT_FALSE(t.alert_at);
}

TEST(Trend, MaintenanceRestartsWhatItRenews) {
  ValveHistory h = a_life(80, 24, 1);
  h.events.push_back({81, EventKind::overhauled, "", ""});
  EXPECT_TRUE(trend(h, {}).trends.empty());
  h.events.back() = {81, EventKind::filter_changed, "", ""};
  const ValveTrend t = trend(h, {});
  EXPECT_EQ(t.trends.size(), 1u);  // r sees the filter, backlash does not
  EXPECT_EQ(t.cause, "feedback_wire_backlash");
}

// What is exchanged is renewed alone; what is done to the whole valve renews every check.
TEST(Trend, AnExchangeRenewsTheFaultThatNamesItAndNoOther) {
  int named = 0;
  for (const Progressive& p : progressive_faults()) {
    Check c;
    c.name = CheckName::of_row(p.row), c.cause = p.fault->name;
    EXPECT_EQ(resets(EventKind::filter_changed, c), p.fault->renewed_by == EventKind::filter_changed) << p.fault->name;
    named += p.fault->renewed_by == EventKind::filter_changed;
    for (const EventKind whole : {EventKind::valve_swapped, EventKind::overhauled, EventKind::retuned})
      EXPECT_TRUE(resets(whole, c)) << p.fault->name;
    EXPECT_FALSE(resets(EventKind::note, c)) << p.fault->name;
  }
  EXPECT_EQ(named, 1);
}

TEST(Trend, ChecksOnAnotherTunedTableAreSetApartAloud) {
  ValveHistory h = a_life(80, 24, 1);
  for (std::size_t k = 0; k < 30; ++k) h.recordings[k].table_sha256 = "old";
  const ValveTrend t = trend(h, {});
  EXPECT_EQ(find(t, "fidelity").points.size(), h.recordings.size() - 30);
  ASSERT_FALSE(t.notes.empty());
  EXPECT_EQ(t.notes.front().kind, Note::Kind::other_table);
  EXPECT_NE(t.notes.front().text.find("30 checks"), std::string::npos);
}

TEST(Trend, AUsersFailureLevelCountsAndALowerOneToo) {
  TrendSettings options;
  options.failure["fidelity"] = {0.9, 1.7};
  const ValveTrend t = trend(a_life(80, 1e9, 2), options);
  EXPECT_EQ(find(t, "fidelity").failure.lower, 0.9);
  EXPECT_EQ(find(t, "fidelity").failure.upper, 1.7);
}

// Fig. 13 with a straight line: the tangent is the line, and the end is where it meets the failure level.
TEST(Trend, TheTangentRuleIsExactForALine) {
  std::vector<double> time, value;
  for (int k = 0; k <= 60; ++k) time.push_back(k), value.push_back(1 + 0.01 * k);
  const auto rule = tangent_rule(time, value, 1.1, 1.3, 2.0);
  ASSERT_TRUE(rule);
  EXPECT_NEAR(rule->alert_at, 30, 1.01);
  EXPECT_NEAR(rule->time_to_failure, 70, 1e-6);
  EXPECT_FALSE(tangent_rule(time, value, 1.1, 1.7, 2.0));
}

// A life of one parameter: `value` over the part s of the way, a check every 2 h, without temperature.
template <class F>
ValveHistory of_one(const std::string& name, const F& value, double noise, double std_error, int checks = 40) {
  ValveHistory h;
  h.valve = "v";
  Random random(8, 7);
  for (int k = 0; k < checks; ++k) {
    Recording r;
    r.at = 2 * k, r.table_sha256 = "a", r.temperature = 313;
    const double v = value(k / 60.0) + noise * random.normal();
    r.checks.push_back({name, v, std_error, "", v, 1, ""});
    h.recordings.push_back(r);
  }
  return h;
}

// What multiplies does so to the tuned value, and an estimate that errs in health errs by as much later.
TEST(Trend, AMultiplyingSeverityHasFailedThatManyTunedValuesBeyondWhereItBegan) {
  ValveHistory h = of_one(
      "parameter:14", [](double s) { return 0.7 + 19 * 1.6 * s; }, 0.3, 0.1);
  h.tuned.assign(41, 0.0);
  h.tuned[13] = 1.6;
  const ValveTrend t = trend(h, {});
  EXPECT_EQ(t.cause, "sticky_spool");  // by its row: a history of another origin names no cause
  EXPECT_NEAR(*find(t, "parameter:14").failure.upper, 0.7 + 19 * 1.6, 0.5);
  ASSERT_TRUE(t.remaining);
  EXPECT_LE(t.remaining->lower, 42);  // true: 120 - 78
  EXPECT_GE(t.remaining->upper, 42);
  h.tuned.clear();  // without the table: of where it began
  EXPECT_NEAR(*find(trend(h, {}), "parameter:14").failure.upper, 20 * 0.7, 6);
}

// A user's level of what multiplies is a multiple of the tuned value, whatever the first checks read.
TEST(Trend, AMultipleOfWhatMultipliesIsOfTheTunedValue) {
  ValveHistory h = of_one(
      "parameter:14", [](double s) { return 0.7 + 31.3 * s; }, 0.3, 0.1);
  h.tuned.assign(41, 0.0);
  h.tuned[13] = 1.6;
  TrendSettings options;
  options.failure_ratio["parameter:14"] = 20;
  const ValveTrend t = trend(h, options);
  EXPECT_NEAR(*find(t, "parameter:14").failure.upper, 32, 1e-9);
  ASSERT_TRUE(t.remaining);
  EXPECT_NEAR(t.remaining->median, 42, 4);
}

// Two tables of one valve, their nozzles' bores 4 % and their motors 6 % apart: all of the friction is read 14 %
// differently, and it has failed where it takes the same current.
TEST(Trend, AFrictionsLevelAsACurrentKnowsNeitherBoreNorMotor) {
  for (const double side : {-1, 1}) {
    const double bore = 1 - 0.02 * side, motor = 1 + 0.03 * side, newtons = motor / (bore * bore);
    ValveHistory h = of_one(
        "parameter:14", [&](double s) { return (1.6 + 30.4 * s) * newtons; }, 0.3, 0.1);
    h.tuned.assign(41, 0.0);
    h.tuned[2] = 100 * motor;
    h.tuned[13] = 1.6;
    h.tuned[5] = std::numbers::pi * bore * 0.35e-3, h.tuned[12] = 7e-3;  // nozzle 20 times narrower than the spool
    TrendSettings options;
    options.failure_current["parameter:14"] = 32.0 / 400 / 100;
    options.failure_spread["parameter:14"] = 0.32 / 400 / 100;
    const ValveTrend t = trend(h, options);
    EXPECT_NEAR(*find(t, "parameter:14").failure.upper, 32 * newtons, 1e-9);
    ASSERT_TRUE(t.remaining);
    EXPECT_NEAR(t.remaining->median, 42, 4);
    h.tuned.clear();
    const std::vector<Note> notes = trend(h, options).notes;
    ASSERT_EQ(notes.size(), 1U);
    EXPECT_EQ(notes.front().kind, Note::Kind::failure_level) << "nothing says what friction that is";
  }
}

// An estimate that recovers, or a tune that was wrong: there is a trend, and no life.
TEST(Trend, WhatMovesAwayFromFailureIsGivenNoLife) {
  const auto to = [](double last) {
    const ValveHistory h = of_one(
        "parameter:9", [&](double s) { return 10e-6 + (last - 10e-6) * s; }, 1e-7, 1e-7);
    TrendSettings options;
    options.failure["parameter:9"].second = 20e-6;
    return trend(h, options);
  };
  const ValveTrend away = to(3e-6), towards = to(17e-6);
  EXPECT_TRUE(find(away, "parameter:9").trend);
  EXPECT_FALSE(away.alert_at);
  EXPECT_FALSE(away.remaining);
  EXPECT_FALSE(find(away, "parameter:9").remaining);
  EXPECT_TRUE(towards.remaining);
}

// Who set a level may know it better, or less well, than the fault's file does.
TEST(Trend, TheStatedSpreadOfALevelSetsTheIntervalOfTheLife) {
  const ValveHistory h = of_one(
      "parameter:9", [](double s) { return 20e-6 * s; }, 1e-7, 1e-7);
  const auto width = [&](double spread) {
    TrendSettings options;
    options.failure["parameter:9"].second = 20e-6;
    options.failure_spread["parameter:9"] = spread;
    const ValveTrend t = trend(h, options);
    return t.remaining ? t.remaining->upper - t.remaining->lower : 0.0;
  };
  // 120 h to 20 um: 6 h a micrometre, 3.29 standard deviations in 90 %.
  EXPECT_NEAR(width(2e-6), 3.29 * 2 * 6, 10);
  EXPECT_LT(width(2e-7), 0.4 * width(2e-6));
}

// A clean filter's size is on no data sheet: a model that takes it for a tenth or for half blocked sees less left at
// the end.
TEST(Trend, ABlockedFilterHasFailedWhenAQuarterIsLeftOfWhatWasOpen) {
  for (const double open : {0.9, 0.5}) {
    const ValveTrend t = trend(of_one(
                                   "parameter:1", [&](double s) { return 1 - open * (1 - 0.75 * s); }, 0.01, 0.01),
                               {});
    EXPECT_NEAR(*find(t, "parameter:1").failure.upper, 1 - open * 0.25, 0.015);  // 0.75 without the size
    ASSERT_TRUE(t.remaining);
    EXPECT_NEAR(t.remaining->median, 42, 12);
  }
}

// A weak motor and a filter that is read widely: the filter comes nearer to its end by chance, the motor has surely
// come half of the way.
TEST(Trend, TheCauseIsWhatHasSurelyComeFurthest) {
  ValveHistory h = of_one(
      "parameter:3", [](double s) { return 100 * (1 - 0.8 * s); }, 0.3, 0.3);
  h.tuned.assign(41, 0.0);
  h.tuned[2] = 100;
  Random random(5, 12);
  for (std::size_t k = 0; k < h.recordings.size(); ++k) {
    const double drop = std::max(0.5, 1 + 0.19 * std::max(0.0, static_cast<double>(k) - 20) + 2 * random.normal());
    const double b = 1 - 1 / std::sqrt(drop);
    h.recordings[k].checks.push_back({"parameter:1", b, std::pow(drop, -1.5), "1", b, 1, ""});
  }
  const ValveTrend t = trend(h, {});
  ASSERT_TRUE(find(t, "parameter:1").trend);
  EXPECT_GT(find(t, "parameter:1").now, 0.75 * 0.6);  // beside the motor's 0.52 / 0.8
  EXPECT_EQ(t.cause, "torque_motor_loss");
  EXPECT_NEAR(t.remaining->median, 42, 4);
}

// The drop over the filter is read too small by a quarter of a clean one's at every check, so that a nearly clean one
// reads larger than clean: no late onset follows from that, and no early end.
TEST(Trend, AConstantErrorOfTheDropOverAFilterIsNoLateOnset) {
  constexpr int valves = 3;
  double sum = 0;
  for (std::uint64_t seed = 0; seed < valves; ++seed) {
    ValveHistory h = of_one(
        "parameter:1", [](double) { return 0.0; }, 0.0, 0.0);
    Random random(seed, 11);
    for (std::size_t k = 0; k < h.recordings.size(); ++k) {
      // Half laminar, half inertial at 40 degC, as fine screens are.
      const double open = 1 - 0.75 * static_cast<double>(k) / 60,
                   drop = 0.5 / open + 0.5 / (open * open) - 0.25 + 0.1 * random.normal();
      const double over_open = std::max(std::sqrt(0.25 + 2 * std::max(drop, 0.0)) - 0.5, 0.5);
      Check& c = h.recordings[k].checks[0];
      c.value = c.measured = 1 - 1 / over_open;
      c.std_error = 0.1 / ((over_open + 0.5) * over_open * over_open);
    }
    TrendSettings options;
    options.failure["parameter:1"].second = 0.75;
    options.failure_spread["parameter:1"] = 0.005;
    const ValveTrend t = trend(h, options);
    sum += t.remaining ? t.remaining->median : 0.0;
  }
  EXPECT_NEAR(sum / valves, 42, 4);
}

// A filter as a model reads it that errs in the bores beside it, which adds to the drop and shows in warm oil, and in
// how much of a screen's drop is laminar, which multiplies it in cold oil; read no lower than half of a clean drop.
ValveHistory a_filter(double worn_at_end, int checks, std::uint64_t seed, double coldest = 243) {
  ValveHistory h;
  h.valve = "v";
  Random random(seed, 13);
  for (int k = 0; k < checks; ++k) {
    Recording r;
    r.at = 2 * k, r.table_sha256 = "a", r.temperature = random.uniform(coldest, 343);
    const double z = std::log(oil_at(860, 14e-6, r.temperature).viscosity_ratio), thick = std::exp(z);
    const double open = 1 - worn_at_end * k / 60, beside = -1.2 * 2 / (1 + thick);
    const double drop = (1 + 0.2 * z * z) / (open * open) + beside + 0.25 * random.normal();
    const double read = std::max(drop, 0.5);
    r.checks.push_back({"parameter:1", 1 - 1 / std::sqrt(read), 0.15 * std::pow(read, -1.5), "1", 0, 1, ""});
    h.recordings.push_back(r);
  }
  return h;
}

// Median and width of the life that is left at 84 h of 120, both in parts of the true one; means over four valves.
std::pair<double, double> left_of_a_filter(double coldest) {
  TrendSettings options;
  options.failure["parameter:1"].second = 1 - 1 / std::sqrt(16 - 1.2);  // as such a valve reads three quarters
  options.failure_spread["parameter:1"] = 0.01;
  constexpr int valves = 4;
  double median = 0, width = 0;
  for (std::uint64_t seed = 0; seed < valves; ++seed) {
    const ValveTrend t = trend(a_filter(0.75, 43, seed, coldest), options);
    EXPECT_TRUE(t.alert_at);
    if (!t.remaining) continue;
    median += t.remaining->median / 36 / valves, width += (t.remaining->upper - t.remaining->lower) / 36 / valves;
  }
  return {median, width};
}

// In warm oil half of the readings say no more than that they are at their end, and the bores take a clean drop off the
// others: as readings like others, and without bores, the end came a third too early.
TEST(Trend, ReadingsAtTheirEndAndWhatIsWrongBesideAFilterAreNoLateOnset) {
  EXPECT_NEAR(left_of_a_filter(293).first, 1, 0.17);
}

// Cold readings twice too large for life say as much as warm ones: taken for scatter the interval is twice as wide.
TEST(Trend, AFilterThatReadsLargerInTheColdForLifeIsReadInTheColdToo) {
  const auto [median, width] = left_of_a_filter(243);
  EXPECT_NEAR(median, 1, 0.12);
  EXPECT_LT(width, 0.75);
}

TEST(Trend, AHealthyFilterIsSilentThroughWarmAndColdErrorsAndTheEndOfItsReadings) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const ValveTrend t = trend(a_filter(0, 60, seed), {});
    EXPECT_FALSE(t.alert_at) << seed;
    EXPECT_FALSE(find(t, "parameter:1").trend) << seed;
  }
}

TEST(Trend, ACheckThatScattersBeyondFailureInHealthSaysThatItIsBlind) {
  const ValveTrend t = trend(of_one(
                                 "parameter:9", [](double) { return 5e-6; }, 9e-6, 9e-6),
                             {});
  const CheckTrend& c = find(t, "parameter:9");
  EXPECT_TRUE(c.blind);
  EXPECT_EQ(c.state, TrendState::blind);
  EXPECT_FALSE(c.threshold.upper);
  ASSERT_EQ(t.notes.size(), 1u);
  EXPECT_EQ(t.notes.front().kind, Note::Kind::blind);
  EXPECT_NE(t.notes.front().text.find("only a trend can warn"), std::string::npos);
}

TEST(Trend, WhatIsFailedByOneLevelIsFailedByEveryNearerOne) {
  for (const double level : {1.5e-6, 2e-6, 3e-6, 5e-6, 9e-6}) {
    TrendSettings o;
    o.failure["parameter:9"].second = level;
    EXPECT_EQ(find(trend(a_life(100, 0, 1), o), "parameter:9").state, TrendState::failed) << level;
  }
}

TEST(Trend, ALevelOnTheSideOfHealthIsTold) {
  TrendSettings o;
  o.failure["fidelity"].second = 0.5;
  const ValveTrend t = trend(of_one(
                                 "fidelity", [](double) { return 1.2; }, 0.01, 0.01),
                             o);
  ASSERT_FALSE(t.notes.empty());
  EXPECT_EQ(t.notes.front().kind, Note::Kind::failure_level);
  EXPECT_NE(t.notes.front().text.find("beyond its failure level already"), std::string::npos);
}

TEST(Trend, ReadingsThatAreNoneAreNotHealth) {
  ValveHistory h = of_one(
      "fidelity", [](double) { return 1.2; }, 0.01, 0.01);
  h.recordings[5].checks[0].value = 0;
  const ValveTrend t = trend(h, {});
  EXPECT_EQ(t.state, TrendState::unknown);
  ASSERT_EQ(t.notes.size(), 1u);
  EXPECT_EQ(t.notes.front().kind, Note::Kind::implausible);
  EXPECT_NE(t.notes.front().text.find("fidelity"), std::string::npos);
}

TEST(Trend, OneOutlyingCheckRaisesNoAlert) {
  ValveHistory h = of_one(
      "parameter:9", [](double) { return 1e-6; }, 3e-7, 1e-7);
  h.recordings.back().checks[0].value = 9e-6;
  const ValveTrend t = trend(h, {});
  EXPECT_FALSE(t.alert_at);
  EXPECT_EQ(t.state, TrendState::watch);
}

TEST(Trend, SameHistorySameTrendOnAnyThreads) {
  TrendSettings one, two;
  one.threads = 1, two.threads = 2;
  const ValveTrend a = trend(a_life(80, 24, 1), one), b = trend(a_life(80, 24, 1), two);
  EXPECT_EQ(a.life, b.life);
}

}  // namespace
}  // namespace servodx
