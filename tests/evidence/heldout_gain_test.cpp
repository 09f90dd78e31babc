// The share of a held-out misfit that is removed, and its interval.
#include "evidence/heldout_gain.h"

#include <gtest/gtest.h>

#include <vector>

namespace servodx {
namespace {

TEST(HeldoutGain, BlocksThatAllGainTheSameLeaveNoDoubt) {
  const Interval g = heldout_gain({4, 8, 2}, {1, 2, 0.5}, 1, 200);
  EXPECT_DOUBLE_EQ(g.value, 0.75);
  EXPECT_DOUBLE_EQ(g.lower, 0.75);
  EXPECT_DOUBLE_EQ(g.upper, 0.75);
}

TEST(HeldoutGain, AGainOfOneBlockAloneIsNotBeyondItsInterval) {
  std::vector<double> before(12, 1.0), after(12, 1.0);
  before[3] = 5;
  const Interval g = heldout_gain(before, after, 1, 1000);
  EXPECT_DOUBLE_EQ(g.value, 0.25);
  EXPECT_EQ(g.lower, 0) << "a third of the draws miss the block";
  EXPECT_GT(g.upper, 0.25);
}

TEST(HeldoutGain, IsAFunctionOfItsSeed) {
  const std::vector<double> before = {3, 1, 4, 1, 5, 9, 2, 6}, after = {1, 1, 3, 2, 4, 5, 2, 3};
  EXPECT_EQ(heldout_gain(before, after, 7, 100).lower, heldout_gain(before, after, 7, 100).lower);
  EXPECT_EQ(heldout_gain({0, 0}, {1, 1}, 7, 100).value, 0) << "of nothing, nothing is removed";
}

}  // namespace
}  // namespace servodx
