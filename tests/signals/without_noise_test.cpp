#include "signals/without_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

double rms_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST(Smoother, StraightLinePassesUnchanged) {
  std::vector<double> x(400);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = 3.0 - 0.25 * static_cast<double>(k);
  EXPECT_LT(rms_difference(without_noise(x), x), 1e-6);
}

TEST(Smoother, SignalWithoutNoisePassesNearlyUnchanged) {
  std::vector<double> x(2000);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] = std::sin(0.3 * static_cast<double>(k)) + (k > 1000 ? 2.0 : 0.0);
  EXPECT_LT(rms_difference(without_noise(x), x), 0.02);
}

// Whatever the signal, the smoothed series lies nearer to the truth than the measured one; the slower, the nearer.
TEST(Smoother, SlowerSignalsLoseMoreOfTheirNoise) {
  double last = 1.0;
  for (const double rate : {0.3, 0.03, 0.003, 0.0}) {
    double worst = 0;
    for (unsigned seed = 0; seed < 10; ++seed) {
      Random random(5, seed);
      std::vector<double> truth(4000), x(4000);
      for (std::size_t k = 0; k < x.size(); ++k) {
        truth[k] = 10.0 * std::sin(rate * static_cast<double>(k));
        x[k] = truth[k] + random.normal();
      }
      worst = std::max(worst, rms_difference(without_noise(x), truth));
    }
    std::printf("rate %g per sample: %.3f of the noise left\n", rate, worst);
    EXPECT_LT(worst, last) << rate;
    last = worst;
  }
  EXPECT_LT(last, 0.1);  // a constant
}

TEST(Smoother, ShortSeriesComeBackAsTheyAre) {
  const std::vector<double> x = {1, 5, 2, 8};
  EXPECT_EQ(without_noise(x), x);
}

}  // namespace
}  // namespace servodx
