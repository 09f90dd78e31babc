// Stated probabilities beside how often they were right.
#include "fleet/calibration.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

// `right` of `n` at one probability.
void add(std::vector<Statement>& to, double probability, int right, int n) {
  for (int i = 0; i < n; ++i) to.push_back({probability, i < right});
}

TEST(Calibration, WhatIsRightAsOftenAsStatedHasNoError) {
  std::vector<Statement> all;
  add(all, 0.55, 55, 100), add(all, 0.75, 75, 100), add(all, 0.95, 95, 100);
  const Calibration c = calibration_of(all, 1);
  EXPECT_NEAR(c.error, 0, 1e-12);
  EXPECT_EQ(c.lower, 0);
  EXPECT_GT(c.upper, 0.02);
  EXPECT_LT(c.upper, 0.1);
  EXPECT_NEAR(c.stated, 0.75, 1e-12);
  EXPECT_EQ(c.right.counted, 225);
  EXPECT_EQ(c.right.of, 300);
}

TEST(Calibration, ChanceAloneIsNoError) {
  int not_refused = 0, below = 0;
  for (std::uint32_t set = 0; set < 20; ++set) {
    Random random(7, set);
    std::vector<Statement> all;
    for (int i = 0; i < 100; ++i) {
      const double p = random.uniform(0.4, 1);
      all.push_back({p, random.uniform() < p});
    }
    const Calibration c = calibration_of(all, 1);
    EXPECT_GT(c.error, 0.01) << "chance shows";
    not_refused += c.lower == 0;
    below += c.error <= c.by_chance;
  }
  EXPECT_GE(not_refused, 17);
  EXPECT_EQ(not_refused, below);
}

TEST(Calibration, ProbabilitiesThatAreTooHighHaveTheDifferenceForAnError) {
  std::vector<Statement> all;
  add(all, 0.9, 120, 200);
  const Calibration c = calibration_of(all, 1);
  EXPECT_NEAR(c.error, 0.3, 1e-12);
  EXPECT_GT(c.lower, 0.2);  // a rate of 60 % of 200 has a standard deviation of 3.5 %
  EXPECT_LT(c.lower, 0.26);
  EXPECT_GT(c.upper, 0.34);
  EXPECT_LT(c.upper, 0.4);
  EXPECT_GT(c.lower, c.by_chance);
}

TEST(Calibration, ErrorsOfTwoSignsDoNotCancel) {
  std::vector<Statement> all;
  add(all, 0.9, 80, 100), add(all, 0.6, 70, 100);
  const Calibration c = calibration_of(all, 1);
  EXPECT_NEAR(c.stated, 0.75, 1e-12);
  EXPECT_EQ(c.right.counted, 150);
  EXPECT_NEAR(c.error, 0.1, 1e-12);
}

TEST(Calibration, FewThatAreAllRightLeaveOpenThatSomeAreWrong) {
  std::vector<Statement> all;
  add(all, 0.99, 5, 5);
  const Calibration c = calibration_of(all, 1);
  EXPECT_NEAR(c.error, 0.01, 1e-12);
  EXPECT_EQ(c.lower, 0);
  EXPECT_GT(c.upper, 0.4);  // Wilson's interval of 5 of 5 begins at 57 %
}

TEST(Calibration, ARangeHoldsItsLowerEndAndTheLastOneBoth) {
  std::vector<Statement> all;
  add(all, 0.0, 0, 1), add(all, 0.5, 1, 2), add(all, 0.59, 1, 1), add(all, 0.99, 1, 1), add(all, 0.999, 0, 1),
      add(all, 1.0, 3, 3);
  const Calibration c = calibration_of(all, 1);
  ASSERT_EQ(c.bins.size(), 4u);
  EXPECT_EQ(c.bins[0].from, 0);
  EXPECT_EQ(c.bins[1].from, 0.5);
  EXPECT_EQ(c.bins[1].to, 0.6);
  EXPECT_NEAR(c.bins[1].stated, (0.5 + 0.5 + 0.59) / 3, 1e-12);
  EXPECT_EQ(c.bins[1].right.counted, 2);
  EXPECT_EQ(c.bins[1].right.of, 3);
  EXPECT_EQ(c.bins[2].from, 0.99);
  EXPECT_EQ(c.bins[2].to, 0.999);
  EXPECT_EQ(c.bins[2].right.of, 1);
  EXPECT_EQ(c.bins[3].to, 1);
  EXPECT_EQ(c.bins[3].right.counted, 3);
  EXPECT_EQ(c.bins[3].right.of, 4);
}

TEST(Calibration, WhatIsNoProbabilityIsLeftOut) {
  const Calibration none = calibration_of({{NAN, true}, {1.01, true}, {-0.01, false}}, 1);
  EXPECT_EQ(none.right.of, 0);
  EXPECT_TRUE(none.bins.empty());
  EXPECT_TRUE(std::isnan(none.error));
  EXPECT_EQ(calibration_of({{NAN, true}, {0.5, true}}, 1).right.of, 1);
}

TEST(Calibration, TheSeedDecidesTheIntervalAlone) {
  std::vector<Statement> all;
  add(all, 0.93, 60, 80), add(all, 0.71, 31, 40), add(all, 0.42, 9, 30);
  const Calibration a = calibration_of(all, 1), again = calibration_of(all, 1), b = calibration_of(all, 2);
  EXPECT_EQ(a.lower, again.lower);
  EXPECT_EQ(a.upper, again.upper);
  EXPECT_EQ(a.by_chance, again.by_chance);
  EXPECT_EQ(a.error, b.error);
  EXPECT_NE(a.upper, b.upper);
  EXPECT_NEAR(a.upper, b.upper, 0.02);
}

}  // namespace
}  // namespace servodx
