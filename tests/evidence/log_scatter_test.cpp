// One more healthy log among few: the chance that it is left as wrong is kept over sets of logs.
#include "evidence/log_scatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

TEST(LogScatter, ChancesAreUniformOverSetsOfHealthyLogs) {
  constexpr int sets = 4000;
  int beyond = 0;
  for (std::uint32_t s = 0; s < sets; ++s) {
    std::vector<double> healthy;
    Random random(3, s, 1);
    for (int k = 0; k < 5; ++k) healthy.push_back(std::exp(0.4 + 0.7 * random.normal()));
    beyond += deviate_of(std::exp(0.4 + 0.7 * random.normal()), healthy, {}).chance_above() < 0.05;
  }
  EXPECT_NEAR(static_cast<double>(beyond) / sets, 0.05, 3 * std::sqrt(0.05 * 0.95 / sets));
}

TEST(LogScatter, AUsualSpreadHoldsBackLogsThatHappenToBeAlike) {
  const std::vector<double> alike = {1.0, 1.01, 0.99, 1.0};
  EXPECT_LT(deviate_of(1.2, alike, {}).chance_above(), 0.001);
  EXPECT_GT(deviate_of(1.2, alike, {0.3, 10}).chance_above(), 0.1);
}

TEST(LogScatter, SaysNothingOfFewerThanThree) {
  EXPECT_EQ(deviate_of(100, {1, 1.1}, {0.3, 10}).chance_above(), 1);
  EXPECT_EQ(deviate_of(0, {1, 1.1, 1.2}, {}).chance_above(), 1);
}

}  // namespace
}  // namespace servodx
