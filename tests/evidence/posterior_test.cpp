// Probabilities over causes, something unlisted and nothing add up, and follow the evidence.
#include "evidence/posterior.h"

#include <gtest/gtest.h>

#include <numeric>

namespace servodx {
namespace {

TEST(Posterior, AddsUpToOne) {
  for (const double chance : {1.0, 0.3, 0.01, 1e-9, 0.0})
    for (const double share : {0.0, 0.4, 1.0}) {
      const Posterior p = posterior_of({chance, 0.05, share, {300, 290, 10}});
      EXPECT_NEAR(std::accumulate(p.causes.begin(), p.causes.end(), p.unlisted + p.nothing), 1, 1e-12);
    }
}

TEST(Posterior, NothingIsEvenWhereTheVerdictTurns) {
  EXPECT_DOUBLE_EQ(posterior_of({0.05, 0.05, 0.5, {10}}).nothing, 0.5);
  EXPECT_GT(posterior_of({1, 0.05, 0.5, {10}}).nothing, 0.5);
  EXPECT_LT(posterior_of({1e-4, 0.05, 0.5, {10}}).nothing, 0.01);
}

TEST(Posterior, WhatTheBestCauseLeavesBelongsToNoneOfTheList) {
  EXPECT_NEAR(posterior_of({0, 0.05, 0.25, {10}}).unlisted, 0.75, 1e-12);
  EXPECT_EQ(posterior_of({0, 0.05, 0.9, {}}).unlisted, 1) << "no cause";
}

TEST(Posterior, ALargeEffectDoesNotMakeASmallDifferenceCertain) {
  const Posterior small = posterior_of({0, 0.05, 1, {20, 10}}), large = posterior_of({0, 0.05, 1, {20000, 19990}});
  EXPECT_GT(small.causes[0], 0.95);
  EXPECT_LT(large.causes[0], 0.6);
}

}  // namespace
}  // namespace servodx
