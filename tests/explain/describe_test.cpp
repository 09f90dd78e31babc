// A size is told within what is physical, or not at all.
#include "explain/describe.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/normal.h"
#include "explain/explain.h"
#include "explain/outcome.h"
#include "explain/subject.h"

namespace servodx {
namespace {

const Number mass{{"mount_mass", "kg", 0, 200, false, 0}, 0};

TEST(Size, HasItsIntervalWhereThatLiesInsideItsRange) {
  const ExplainedParameter p = sized(mass, 100, 10);
  EXPECT_EQ(p.told, SizeTold::interval);
  EXPECT_DOUBLE_EQ(p.lower, 100 - 10 * normal_95_one_sided);
  EXPECT_DOUBLE_EQ(p.upper, 100 + 10 * normal_95_one_sided);
  EXPECT_EQ(p.name, "mount_mass");
  EXPECT_EQ(p.unit, "kg");
  EXPECT_EQ(p.std_error, 10);
}

TEST(Size, EndsWhereTheNumberMayNotGo) {
  const ExplainedParameter least = sized(mass, 10, 20), most = sized(mass, 190, 20);
  EXPECT_EQ(least.told, SizeTold::interval);
  EXPECT_EQ(least.lower, 0);
  EXPECT_DOUBLE_EQ(least.upper, 10 + 20 * normal_95_one_sided);
  EXPECT_DOUBLE_EQ(most.lower, 190 - 20 * normal_95_one_sided);
  EXPECT_EQ(most.upper, 200);
}

TEST(Size, ThatMayBeAnythingInItsRangeIsNotTold) {
  const ExplainedParameter p = sized(mass, 148, 65169);
  EXPECT_EQ(p.told, SizeTold::not_told);
  EXPECT_EQ(p.lower, 0);
  EXPECT_EQ(p.upper, 200);
}

TEST(Size, AtABoundHasNoInterval) {
  const ExplainedParameter p = sized(mass, 200, std::nan(""));
  EXPECT_EQ(p.told, SizeTold::at_bound);
  EXPECT_TRUE(std::isnan(p.lower) && std::isnan(p.upper));
}

// A factor on what a log has of its own: range, interval and the value before are of that.
TEST(Size, OfAFactorIsOfWhatItMultiplies) {
  const Number times{{"air_fraction", "-", 0.1, 10, true, 1}, 1};
  const ExplainedParameter p = sized(times, 8, 2, 0.01);
  EXPECT_DOUBLE_EQ(p.value, 0.08);
  EXPECT_DOUBLE_EQ(p.before, 0.01);
  EXPECT_DOUBLE_EQ(p.lower, 0.01 * (8 - 2 * normal_95_one_sided));
  EXPECT_DOUBLE_EQ(p.upper, 0.1);
  EXPECT_EQ(sized(times, 8, 20, 0.01).told, SizeTold::not_told);
}

}  // namespace
}  // namespace servodx
