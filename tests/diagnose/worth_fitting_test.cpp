#include "diagnose/worth_fitting.h"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/constants.h"
#include "evidence/probabilities.h"

namespace servodx {
namespace {

// With as many samples as the best leaves, the scale is 1 and a hundredth of the effect a sample.
TEST(WorthFitting, OnlyWhatIsWorseThanHealthAndHasNoChanceIsHopeless) {
  constexpr double degrees = 100;
  const double reach = diagnose_constants::hopeless;
  EXPECT_FALSE(is_hopeless(100 + reach - 1, 100, 100, degrees)) << "within reach of health";
  EXPECT_TRUE(is_hopeless(100 + reach + 1, 100, 100, degrees));
  EXPECT_FALSE(is_hopeless(9999, 10000, 100, degrees)) << "a second fault may stand beside what gains anything";
  // A model errs by a part of the effect, so that a large effect leaves room: a hundredth of 9900 a sample, and more.
  EXPECT_FALSE(is_hopeless(10001, 10000, 10000 - reach, degrees));
  EXPECT_TRUE(is_hopeless(10001, 10000, 100, degrees));
}

TEST(WorthFitting, WhatIsHopelessHasNoPartOfTheProbability) {
  for (const double best : {80.0, 100.0, 3000.0}) {
    const double healthy = best + 5 * diagnose_constants::hopeless, scale = misfit_scale(healthy, best, 100, 0.1);
    double misfit = healthy;
    while (!is_hopeless(misfit, healthy, best, 100)) misfit += 1;
    const std::vector<double> p = probabilities_of({{1, best}, {1, healthy}, {1, misfit}}, scale);
    EXPECT_LT(p[2], 1e-10) << best;
  }
}

TEST(WorthFitting, APairGainsWhatItLeavesLessButForWhatTheFirstLends) {
  EXPECT_DOUBLE_EQ(pair_gain(60, 100, 60), 40) << "no effect, nothing lent";
  EXPECT_DOUBLE_EQ(pair_gain(60, 100, 4060), 30) << "a twentieth of the amplitude of 4000";
  EXPECT_TRUE(pair_could_gain(100, 4000));
  EXPECT_FALSE(pair_could_gain(100, 175000)) << "were nothing left, the first might lend all of it";
  for (const double misfit : {0.0, 20.0, 90.0}) EXPECT_LE(pair_gain(misfit, 100, 175000), 0);
}

}  // namespace
}  // namespace servodx
