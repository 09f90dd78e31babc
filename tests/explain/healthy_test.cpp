// What counts as news against healthy logs: at the rate that is stated.
#include "explain/healthy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/random.h"
#include "base/student.h"
#include "evidence/tail_law.h"
#include "explain/beside_healthy.h"
#include "explain/constants.h"

namespace servodx {
namespace {

// A log of a rig whose causes' sizes scatter by tau beyond their standard errors.
HealthyLog draw(Random& random, int causes, double moved, int which) {
  HealthyLog log;
  log.adequacy = std::exp(0.3 * random.normal());
  for (int c = 0; c < causes; ++c) {
    const double error = std::exp(random.uniform(-1, 1)), tau = 0.3 * (c % 5);
    const double size = c + tau * random.normal() + error * random.normal() + (c == which ? moved : 0);
    log.scores.push_back({"cause " + std::to_string(c), "here", {{size, error}}, 0});
  }
  return log;
}

double smallest(const HealthyTest& test, const HealthyLog& log) {
  double p = 1;
  for (const HealthyScore& s : log.scores) p = std::min(p, test.together(test.alone({s})));
  return p;
}

TEST(Student, TailsAreThoseOfTheTables) {
  EXPECT_NEAR(student_tail(2.262157, 9), 0.05, 1e-6);
  EXPECT_NEAR(student_tail(4.604095, 4), 0.01, 1e-6);
  EXPECT_NEAR(student_tail(0, 7), 1.0, 1e-12);
  EXPECT_NEAR(student_tail(12.7062047, 1), 0.05, 1e-6);
}

TEST(Student, TheQuantileHasTheTailThatWasAskedFor) {
  for (const double degrees : {1.0, 4.0, 9.0, 30.0})
    for (const double chance : {0.5, 0.05, 1e-4})
      EXPECT_NEAR(student_tail(student_quantile(chance, degrees), degrees), chance, 1e-9 * chance + 1e-12)
          << degrees << " degrees, " << chance;
}

TEST(Healthy, FalseAlarmsComeAtTheRateStated) {
  constexpr int trials = 600, causes = 30;
  for (const double level : {0.1, 0.02}) {
    int alarms = 0;
    for (int k = 0; k < trials; ++k) {
      Random random(41, static_cast<std::uint32_t>(k));
      HealthyReference reference;
      for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, causes, 0, -1));
      alarms += smallest(HealthyTest(reference), draw(random, causes, 0, -1)) <= level;
    }
    const double sd = std::sqrt(level * (1 - level) / trials);
    EXPECT_LT(alarms / static_cast<double>(trials), 1.5 * level + 2.5 * sd) << level;
    std::printf("level %g: %d alarms in %d healthy logs\n", level, alarms, trials);
  }
}

TEST(Healthy, WhatHasMovedFarIsFound) {
  int found = 0;
  constexpr int trials = 100;
  for (int k = 0; k < trials; ++k) {
    Random random(43, static_cast<std::uint32_t>(k));
    HealthyReference reference;
    for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, 30, 0, -1));
    const HealthyTest test(reference);
    const HealthyLog log = draw(random, 30, 40, 7);
    found += test.together(test.alone({log.scores[7]})) <= 0.1;
  }
  EXPECT_GE(found, 95);
}

// Tests that hardly show a cause lend it whatever else is wrong: sizes scatter in proportion to their standard errors.
HealthyScore lent(Random& random, double error) { return {"leak", "here", {{10 * error * random.normal(), error}}, 0}; }

TEST(Healthy, TestsThatHardlyShowACauseDoNotHideItWhereOneShowsItWell) {
  constexpr int trials = 200;
  int found = 0, alarms = 0;
  for (int k = 0; k < trials; ++k) {
    Random random(47, static_cast<std::uint32_t>(k));
    HealthyReference reference;
    for (int i = 0; i < 9; ++i) {
      reference.logs.emplace_back();
      reference.logs.back().scores.push_back(lent(random, std::exp(random.uniform(-3, 1))));
    }
    const HealthyTest test(reference);
    found += test.alone({{"leak", "here", {{5.0, 0.05}}, 0}}) <= 0.01;
    alarms += test.alone({lent(random, std::exp(random.uniform(-3, 1)))}) <= 0.05;
  }
  EXPECT_GE(found, trials * 9 / 10);
  EXPECT_LE(alarms, 0.05 * trials + 2.5 * std::sqrt(0.05 * 0.95 * trials));
}

// Where the model's answer to the oil is off, sizes follow its viscosity: what lies on that line is no news however far
// out, and what lies off it is, though other oils show as much.
TEST(Healthy, SizesThatFollowTheOilAreJudgedBesideTheirLine) {
  constexpr int trials = 200;
  int found = 0, alarms = 0, with_nothing_known = 0;
  for (int k = 0; k < trials; ++k) {
    Random random(48, static_cast<std::uint32_t>(k));
    const auto score = [&](double thickness, double moved) {
      return HealthyScore{"friction", "here", {{3 * thickness + 0.1 * random.normal() + moved, 0.05}}, 0, 1, thickness};
    };
    HealthyReference reference;
    for (int i = 0; i < 12; ++i) {
      reference.logs.emplace_back();
      reference.logs.back().scores.push_back(score(random.uniform(-0.5, 0.5), 0));
    }
    const HealthyTest test(reference);
    found += test.alone({score(0, 1.0)}) <= 0.01;
    alarms += test.alone({score(random.uniform(-0.7, 0.7), 0)}) <= 0.05;
    HealthyScore blind = score(0, 1.0);
    for (HealthyLog& l : reference.logs) l.scores[0].thickness = std::nan("");
    blind.thickness = std::nan("");
    with_nothing_known += HealthyTest(reference).alone({blind}) <= 0.01;
  }
  EXPECT_GE(found, trials * 9 / 10);
  EXPECT_LE(with_nothing_known, trials / 10);
  EXPECT_LE(alarms, 0.05 * trials + 2.5 * std::sqrt(0.05 * 0.95 * trials));
}

TEST(Healthy, StandingSizeIsNoNews) {
  // Cause 20 stands at 20 in every log: far from absent, and nothing new.
  Random random(44, 1);
  HealthyReference reference;
  for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, 30, 0, -1));
  const HealthyTest test(reference);
  EXPECT_GT(test.together(test.alone({draw(random, 30, 0, -1).scores[20]})), 0.1);
}

TEST(Healthy, LogsOfOneStateSpeakTogether) {
  Random random(45, 1);
  HealthyReference reference;
  for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, 5, 0, -1));
  const HealthyTest test(reference);
  const HealthyScore one{"cause 4", "here", {{4 + 5.0, 0.5}}, 0};
  EXPECT_LT(test.alone({one, one, one}), test.alone({one}));
}

// Two logs of one day have its oil and its air: what those make of a cause is the same in both.
TEST(Healthy, LogsOfOneDayAreNoTwoWitnesses) {
  constexpr int trials = 600, causes = 20;
  int alarms = 0;
  for (int k = 0; k < trials; ++k) {
    Random random(48, static_cast<std::uint32_t>(k));
    constexpr double error = 0.1;
    const auto day = [&](int logs) {
      std::vector<HealthyLog> out(static_cast<std::size_t>(logs));
      for (int c = 0; c < causes; ++c) {
        const double of_the_day = random.normal();
        for (HealthyLog& log : out)
          log.scores.push_back(
              {"cause " + std::to_string(c), "here", {{of_the_day + error * random.normal(), error}}, 0});
      }
      return out;
    };
    HealthyReference reference;
    for (int i = 0; i < 19; ++i) reference.logs.push_back(day(1).front());
    const HealthyTest test(reference);
    const std::vector<HealthyLog> suspect = day(4);
    double p = 1;
    for (std::size_t c = 0; c < causes; ++c) {
      std::vector<HealthyScore> scores;
      for (const HealthyLog& log : suspect) scores.push_back(log.scores[c]);
      p = std::min(p, test.together(test.alone(scores)));
    }
    alarms += p <= 0.05;
  }
  EXPECT_LE(alarms, 0.05 * trials + 2.5 * std::sqrt(0.05 * 0.95 * trials));
}

// One cause scatters with tails far beyond Student's: it may not accuse, and may not deafen the test for the others.
TEST(Healthy, LongTailsOfOneCauseAreLearntAndStayItsOwn) {
  constexpr int trials = 300, causes = 20;
  int alarms = 0, found = 0;
  for (int k = 0; k < trials; ++k) {
    Random random(49, static_cast<std::uint32_t>(k));
    const auto log = [&](double moved) {
      HealthyLog out = draw(random, causes, moved, 3);
      const double wild = std::tan(1.5 * random.uniform(-1, 1));
      out.scores.push_back({"wild", "here", {{wild, 0.1}}, 0});
      return out;
    };
    HealthyReference reference;
    for (int i = 0; i < 19; ++i) reference.logs.push_back(log(0));
    const HealthyTest test(reference);
    alarms += smallest(test, log(0)) <= 0.05;
    found += test.together(test.alone({log(40).scores[3]})) <= 0.05;
  }
  EXPECT_LE(alarms, 0.05 * trials + 2.5 * std::sqrt(0.05 * 0.95 * trials));
  EXPECT_GE(found, trials * 8 / 10);
}

// One log's cause is of a size that no other shows, and its held-out data refuse it: it hides no one else's.
TEST(Healthy, ACauseThatHeldOutDataRefuseDeafensNoOne) {
  const auto together = [](double lower) {
    Random random(51, 1);
    HealthyReference reference;
    for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, 5, 0, -1));
    HealthyLog& odd = reference.logs.front();
    odd.scores.push_back({"odd", "here", {{40, 1}}, 0});
    for (std::size_t i = 1; i < 9; ++i) reference.logs[i].scores.push_back({"odd", "here", {{0.1, 1}}, 0});
    odd.shares.push_back({"odd", "here", 0.3, lower, 1}), odd.has_shares = true;
    const HealthyTest test(reference);
    return test.together(test.alone({{"cause 4", "here", {{4 + 12.0, 0.5}}, 0}}));
  };
  EXPECT_GE(together(0.1), 2.0 / 10);
  EXPECT_LT(together(-0.1), 0.1);
}

TEST(Healthy, RareCauseHasItsShareOfTheFalseAlarmsAndNoMore) {
  Random random(50, 1);
  HealthyReference reference;
  for (int i = 0; i < 9; ++i) reference.logs.push_back(draw(random, 5, 0, -1));
  const HealthyTest test(reference);
  const HealthyScore one{"cause 4", "here", {{4 + 5.0, 0.5}}, 0};
  HealthyScore rare = one;
  rare.prior = 0.1;
  EXPECT_NEAR(test.alone({rare}), 10 * test.alone({one}), 1e-9);
}

// One log in cold oil that the model follows badly hides no cause in warm oil, and every cause in oil like its own.
TEST(Healthy, AShareOfTheMisfitIsJudgedInTheSuspectsOil) {
  HealthyReference reference;
  const double thick[] = {0.1, -0.2, 0.2, 1.1, 0.0, 1.4, 1.7, -0.4};
  const double share[] = {0.05, 0.10, 0.12, 0.22, 0.06, 0.45, 0.75, 0.08};
  for (int i = 0; i < 8; ++i) {
    HealthyLog log;
    log.adequacy = 1;
    log.scores.push_back({"cause", "here", {{0, 1}}, 0, 1, thick[i]});
    log.shares.push_back({"cause " + std::to_string(i), "here", share[i], share[i], 1}), log.has_shares = true;
    reference.logs.push_back(log);
  }
  const double rate = rate_of_question(0, 8, explain_constants::of_shares);
  EXPECT_LE(HealthyTest(reference, 0.0).shares().chance("another", 0.5), rate);
  EXPECT_GT(HealthyTest(reference, 1.7).shares().chance("another", 0.5), rate);
  EXPECT_GE(HealthyTest(reference).shares().chance("another", 0.5), 2.0 / 9)
      << "without a temperature all logs are alike";
}

TEST(Healthy, ALogThatSetsNoShareStillTellsHowSizesScatterAndWhatIsLeft) {
  HealthyReference reference;
  for (int i = 0; i < 12; ++i) {
    HealthyLog log;
    log.misses.push_back({"flow", 1 + 0.1 * i});
    log.scores.push_back({"cause", "here", {{0.1 * i, 1}}, 0});
    log.shares.push_back({"cause", "here", i > 6 ? 0.8 : 0.05, 0, 1}), log.has_shares = true;
    reference.logs.push_back(log);
  }
  HealthyReference marked = reference;
  for (HealthyLog& log : marked.logs) log.sets_no_share = log.shares.front().share > 0.5;
  const HealthyTest all(reference), without(marked);
  EXPECT_GE(all.shares().chance("cause", 0.7), 6.0 / 13);
  EXPECT_LE(without.shares().chance("cause", 0.7), rate_of_question(0, 12, explain_constants::of_shares));
  EXPECT_EQ(without.miss({"flow", 3}), all.miss({"flow", 3}));
  const HealthyScore three{"cause", "here", {{3, 1}}, 0};
  EXPECT_EQ(without.alone({three}), all.alone({three}));
}

TEST(Healthy, TooFewLogsAccuseNoOne) {
  HealthyReference two;
  Random random(46, 1);
  for (int i = 0; i < 2; ++i) two.logs.push_back(draw(random, 5, 0, -1));
  const HealthyTest test(two);
  EXPECT_EQ(test.together(test.alone({{"cause 1", "here", {{1e6, 1}}, 0}})), 1.0);
}

}  // namespace
}  // namespace servodx
