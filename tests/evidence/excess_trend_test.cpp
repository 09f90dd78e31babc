// Excesses that follow a condition are compared over the scale of their own condition; excesses that do not are left
// alone.
#include "evidence/excess_trend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"
#include "evidence/tail_law.h"

namespace servodx {
namespace {

constexpr int valves = 1500;
constexpr double warmest = -0.5, coldest = 1.7, usual_mean = 0.12;

double exponential(Random& random, double mean) { return -mean * std::log(1 - random.uniform()); }

// Of the excesses there, where the mean over all oils is the usual one.
double mean_at(double at, double slope) {
  const double over_all =
      slope == 0 ? 1 : (std::exp(slope * coldest) - std::exp(slope * warmest)) / (slope * (coldest - warmest));
  return usual_mean / over_all * std::exp(slope * at);
}

// Healthy logs of one valve.
std::vector<ExcessAt> drawn(Random& random, int logs, double slope) {
  std::vector<ExcessAt> out;
  for (int i = 0; i < logs; ++i) {
    const double at = random.uniform(warmest, coldest);
    out.push_back({exponential(random, mean_at(at, slope)), at});
  }
  return out;
}

double chance(const std::vector<ExcessAt>& healthy, double excess, double at) {
  const ExcessTrend trend(healthy);
  std::vector<double> over_their_scale;
  for (const ExcessAt& e : healthy) over_their_scale.push_back(e.excess / trend.scale(e.at));
  return TailLaw(over_their_scale, {usual_mean, 10}).chance(excess / trend.scale(at));
}

TEST(ExcessTrend, FindsTheSlopeOfManyLogsAndNoneWhereThereIsNone) {
  double sum = 0;
  int found = 0;
  for (int v = 0; v < valves; ++v) {
    Random random(91, static_cast<std::uint32_t>(v));
    sum += ExcessTrend(drawn(random, 40, 1.0)).slope() / valves;
    found += ExcessTrend(drawn(random, 10, 0.0)).slope() != 0;
  }
  EXPECT_NEAR(sum, 1.0, 0.15) << "a little towards none, by its prior";
  // Schwarz: 2 ln of the likelihoods' ratio beyond ln 10, of chi-square with one degree, is 13 % of logs by chance.
  EXPECT_LT(found, 0.2 * valves);
}

// The slope of ten logs is not known well, and the law takes it as known: hence half as many again.
TEST(ExcessTrend, HealthyLogsAreAccusedNoMoreOftenThanStatedInAnyOil) {
  constexpr double rate = 0.05;
  for (const double slope : {0.0, 0.7, 1.4})
    for (const double at : {0.0, 1.0}) {
      int accused = 0;
      for (int v = 0; v < valves; ++v) {
        Random random(92, static_cast<std::uint32_t>(v));
        const std::vector<ExcessAt> healthy = drawn(random, 10, slope);
        accused += chance(healthy, exponential(random, mean_at(at, slope)), at) <= rate;
      }
      std::printf("slope %.1f, at %.0f: %d of %d healthy logs at a rate of %g\n", slope, at, accused, valves, rate);
      EXPECT_LT(accused, 1.5 * rate * valves + 2 * std::sqrt(rate * valves)) << slope << ' ' << at;
    }
}

TEST(ExcessTrend, AColdLogThatIsFollowedBadlySpeaksOfColdOil) {
  const std::vector<ExcessAt> healthy = {{0.05, 0.1}, {0.10, -0.2}, {0.12, 0.2}, {0.25, 1.1},
                                         {0.06, 0.0}, {0.60, 1.4},  {1.40, 1.7}, {0.08, -0.4}};
  const double share_of_half = -std::log(0.5);
  EXPECT_LT(chance(healthy, share_of_half, 0.0), 0.01) << "rare in warm oil";
  EXPECT_GT(chance(healthy, share_of_half, 1.7), 0.1) << "common in cold oil";
  // Without the temperatures two of the eight show as much.
  std::vector<double> excesses;
  for (const ExcessAt& e : healthy) excesses.push_back(e.excess);
  EXPECT_GE(TailLaw(excesses, {usual_mean, 10}).chance(share_of_half), 2.0 / 9);
}

TEST(ExcessTrend, IsLevelBeyondItsLogsAndWhereNoTemperatureIsKnown) {
  Random random(93, 1);
  std::vector<ExcessAt> healthy = drawn(random, 40, 1.4);
  const ExcessTrend trend(healthy);
  ASSERT_NE(trend.slope(), 0);
  EXPECT_DOUBLE_EQ(trend.scale(9), trend.scale(4));
  EXPECT_DOUBLE_EQ(trend.scale(std::nan("")), 1);
  healthy[3].at = std::nan("");
  EXPECT_EQ(ExcessTrend(healthy).slope(), 0);
  healthy.resize(5);
  EXPECT_EQ(ExcessTrend(healthy).slope(), 0) << "five logs";
}

}  // namespace
}  // namespace servodx
