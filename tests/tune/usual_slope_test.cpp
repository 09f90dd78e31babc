// What the logs of a tune say of the recorder holds for one more log, and no log that does not tell it is heard.
#include "tune/usual_slope.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace servodx {
namespace {

TEST(UsualSlope, LogsThatAgreeLeaveLittleOpen) {
  const auto found = usual_slope({{0.57, 0.01}, {0.58, 0.01}, {0.56, 0.01}, {0.57, 0.01}});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->usual, 0.57, 0.005);
  EXPECT_LT(found->spread, 0.03);
}

TEST(UsualSlope, ALogThatDoesNotTellItCountsForLittle) {
  const std::vector<SlopeOfLog> agree = {{0.57, 0.01}, {0.58, 0.01}, {0.56, 0.01}};
  std::vector<SlopeOfLog> with = agree;
  with.push_back({0.0, 0.6});
  EXPECT_NEAR(usual_slope(with)->usual, usual_slope(agree)->usual, 0.005);
  EXPECT_NEAR(usual_slope(with)->spread, usual_slope(agree)->spread, 0.01);
}

TEST(UsualSlope, RecordersThatDifferLeaveItOpen) {
  const auto found = usual_slope({{0.0, 0.01}, {1.0, 0.01}, {0.0, 0.01}, {1.0, 0.01}});
  ASSERT_TRUE(found);
  EXPECT_GT(found->spread, 0.4);
}

TEST(UsualSlope, TwoLogsSayNothingOfAThird) {
  EXPECT_FALSE(usual_slope({{0.5, 0.01}, {0.5, 0.01}}));
  EXPECT_FALSE(usual_slope({}));
}

TEST(UsualSlope, OneMoreLogLiesWithinWhatIsLeftOpen) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> error(0.01, 0.2);
  constexpr int trials = 2000;
  for (const double between : {0.0, 0.03, 0.15}) {
    int within = 0;
    for (int t = 0; t < trials; ++t) {
      std::vector<SlopeOfLog> logs;
      for (int l = 0; l < 10; ++l) {
        const double own = error(random);
        logs.push_back({0.5 + between * normal(random) + own * normal(random), own});
      }
      const auto found = usual_slope(logs);
      within += std::abs(0.5 + between * normal(random) - found->usual) < 2 * found->spread;
    }
    const double rate = within / static_cast<double>(trials);
    std::printf("scatter %g: %.3f of new logs within two spreads\n", between, rate);
    EXPECT_GT(rate, 0.88) << between;
  }
}

}  // namespace
}  // namespace servodx
