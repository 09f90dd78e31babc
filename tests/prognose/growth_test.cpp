// Growth, its test and its prediction, on series whose truth is known.
#include "prognose/growth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "prognose/life.h"

namespace servodx {
namespace {

GrowthPrior plain_prior(int direction = 1) {
  return {
      .base = 0, .base_sd = 1, .feature_mean = {}, .feature_sd = {}, .noise = 0.03, .scale = 1, .direction = direction};
}

template <class F>
std::vector<GrowthPoint> series(const F& truth, int n, double noise, std::uint64_t seed, double life = 60) {
  Random random(seed, 5);
  std::vector<GrowthPoint> points;
  for (int k = 0; k < n; ++k)
    points.push_back({static_cast<double>(k), truth(k / life) + noise * random.normal(), 0.0, {}});
  return points;
}

// Ville: under the null a Bayes factor passes 1/alpha with probability alpha at most, however often one looks.
TEST(Growth, HealthySeriesAreSeldomTakenForATrendHoweverOftenOneLooks) {
  constexpr int units = 60;
  int alarms = 0;
  for (int u = 0; u < units; ++u) {
    const auto all = series([](double) { return 0.1; }, 50, 0.03, static_cast<std::uint64_t>(u));
    for (std::size_t k = 10; k <= all.size(); k += 8) {
      const GrowthModel model({all.begin(), all.begin() + static_cast<long>(k)}, plain_prior(0));
      if (model.growth().log_bayes_factor > std::log(20.0)) {
        ++alarms;
        break;
      }
    }
  }
  EXPECT_LE(alarms, 7);  // 5 % of 60 is 3; 7 or more has a chance of 3 %
}

TEST(Growth, ALinearTrendIsSeenAndItsEndLiesInItsInterval) {
  int inside = 0, near = 0;
  constexpr int units = 20;
  for (int u = 0; u < units; ++u) {
    const auto points = series([](double s) { return 0.05 + s; }, 31, 0.02, static_cast<std::uint64_t>(u));
    const GrowthModel model(points, plain_prior());
    EXPECT_GT(model.growth().log_bayes_factor, 10);
    const Life life = model.life({1.05, {}}, 1);  // true: 60 - 30
    inside += life_quantile(life, 0.05) <= 30 && 30 <= life_quantile(life, 0.95);
    near += std::abs(life_quantile(life, 0.5) - 30) < 6;
  }
  EXPECT_GE(inside, 16);
  EXPECT_GE(near, 16);
}

// A screen that loses its area evenly: the drop over it grows ever faster, as its own size says how fast.
TEST(Growth, APartThatIsLostEvenlyEndsWhenItIsLost) {
  GrowthPrior prior = plain_prior();
  prior.base = 1, prior.scale = 15, prior.of_drop = true, prior.noise = 0.3;
  int near = 0;
  constexpr int units = 12;
  for (int u = 0; u < units; ++u) {
    const auto points =
        series([](double s) { return std::pow(1 - 0.75 * s, -2); }, 37, 0.3, static_cast<std::uint64_t>(u), 40);
    const double end = life_quantile(GrowthModel(points, prior).life({16.0, {}}, 1), 0.5);
    near += std::abs(end - 4) < 0.8;  // a fifth of what is left
  }
  EXPECT_GE(near, 11);
}

TEST(Growth, ACurvedTrendIsNotExtrapolatedAsALine) {
  const auto points = series([](double s) { return s * s; }, 43, 0.005, 3);  // 70 % of the life
  const GrowthModel model(points, plain_prior());
  const Life life = model.life({1.0, {}}, 1);
  EXPECT_NEAR(life_quantile(life, 0.5), 18, 4);  // a line through it all would say 42
}

// Laws that are not on the grid, alone and with a Wiener process on top: the intervals must hold.
TEST(Growth, IntervalsCoverTheEndWhateverTheLaw) {
  int inside = 0, units = 0;
  for (const double power : {0.65, 1.0, 1.55})
    for (const double wander : {0.0, 0.05})
      for (std::uint64_t u = 0; u < 10; ++u, ++units) {
        Random random(u, 11);
        std::vector<GrowthPoint> points;
        double astray = 0, end = 0;
        for (int k = 0; end == 0; ++k) {
          astray += wander * random.normal() / std::sqrt(60.0);
          const double y = std::pow(k / 60.0, power) + astray;
          if (k <= 40) points.push_back({static_cast<double>(k), y + 0.02 * random.normal(), 0.0, {}});
          if (y >= 1) end = k - 0.5;
        }
        const Life life = GrowthModel(points, plain_prior()).life({1.0, {}}, 1);
        inside += life_quantile(life, 0.05) <= end - 40 && end - 40 <= life_quantile(life, 0.95);
      }
  EXPECT_GE(inside, units * 80 / 100);
}

TEST(Growth, TemperatureIsNotTakenForGrowth) {
  Random random(9);
  std::vector<GrowthPoint> points;
  for (int k = 0; k < 40; ++k) {
    const double z = random.uniform(-1, 3);
    points.push_back({static_cast<double>(k), 0.2 * z + 0.01 * random.normal(), 0.0, {z}});
  }
  GrowthPrior prior = plain_prior(0);
  prior.feature_mean = {0.0}, prior.feature_sd = {0.3};
  const GrowthModel model(points, prior);
  EXPECT_LT(model.growth().log_bayes_factor, 1);
  EXPECT_NEAR(model.growth().coefficients[0], 0.2, 0.02);
}

// A wear that reads 12 % less of itself for an e-fold of viscosity, its last checks all cold: what counts is how far it
// would read in warm oil.
TEST(Growth, WearThatShowsLessInTheColdIsAsFarAsWarmChecksSay) {
  Random random(10);
  std::vector<GrowthPoint> points;
  for (int k = 0; k < 40; ++k) {
    const double z = k < 34 ? random.uniform(-0.7, 3) : 2.5;
    points.push_back({static_cast<double>(k), k / 60.0 * (1 - 0.12 * z) + 0.005 * random.normal(), 0.0, {z, z * z}});
  }
  GrowthPrior prior = plain_prior();
  prior.feature_mean = {0.0, 0.0}, prior.feature_sd = {0.3, 0.1}, prior.tilt = 0.15;
  const GrowthModel model(points, prior);
  EXPECT_NEAR(life_quantile(model.life({1.0, {}}, 1), 0.5), 60 - 39, 1.5);
  EXPECT_NEAR(model.at_reference(points.back()), 39 / 60.0, 0.03);
}

// Cold checks of which one shows all of the growth and the next half of it: they differ by more than warm ones, which
// then say no less of the end.
TEST(Growth, ColdChecksThatDisagreeDoNotBlurWhatWarmOnesSay) {
  std::vector<GrowthPoint> points;
  Random random(12);
  for (int k = 0; k < 26; ++k) {
    const double z = k % 4 == 2 ? 3.0 : random.uniform(-0.5, 0.5), grown = std::max(0.0, (k - 10) / 30.0);
    const double shown = k % 8 == 2 ? 0.5 : 1.0;
    points.push_back({static_cast<double>(k), grown * shown + 0.01 * random.normal(), 0.0, {z, z * z}, z * grown});
  }
  const auto life = [&](double scatter) {
    GrowthPrior prior = plain_prior();
    prior.feature_mean = {0.0, 0.0}, prior.feature_sd = {0.3, 0.1}, prior.tilt = 0.15, prior.scatter = scatter;
    return GrowthModel(points, prior).life({1.0, {}}, 1);
  };
  const auto width = [](const Life& l) { return life_quantile(l, 0.95) - life_quantile(l, 0.05); };
  EXPECT_NEAR(life_quantile(life(0.15), 0.5), 40 - 25, 3);
  EXPECT_LT(width(life(0.15)), 0.7 * width(life(0)));
}

// The level itself is known to a third only; the curve exactly. The median is where the curve passes the level's
// middle.
TEST(Growth, AWideLevelDoesNotMoveTheMiddleOfTheLife) {
  const auto points = series([](double s) { return s; }, 55, 1e-4, 6);
  const GrowthModel model(points, plain_prior());
  for (std::uint64_t seed = 1; seed < 6; ++seed)
    EXPECT_NEAR(life_quantile(model.life({.upper = 1.0, .lower = {}, .sd = 0.3}, seed), 0.5), 60 - 54, 0.3);
}

TEST(Growth, ChecksOfLargeErrorWeighLittle) {
  auto points = series([](double s) { return s; }, 31, 0.01, 4);
  for (int k = 0; k < 31; k += 3)
    points[static_cast<std::size_t>(k)].y = 0.9, points[static_cast<std::size_t>(k)].variance = 1.0;
  const GrowthModel model(points, plain_prior());
  EXPECT_NEAR(model.growth().now, 0.5, 0.03);
}

TEST(Growth, SameSeedSameLife) {
  const auto points = series([](double s) { return s; }, 31, 0.02, 5);
  EXPECT_EQ(GrowthModel(points, plain_prior()).life({1.0, {}}, 7),
            GrowthModel(points, plain_prior()).life({1.0, {}}, 7));
}

}  // namespace
}  // namespace servodx
