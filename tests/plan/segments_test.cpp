// The pieces of a planned test: whole cycles, as long on either side, within the amplitude.
#include "plan/segments.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/random.h"

namespace servodx {
namespace {

double sum(const std::vector<double>& x) { return std::accumulate(x.begin(), x.end(), 0.0); }

TEST(Segments, EveryShapeSpendsAsLongOnEitherSide) {
  const Timing timing = single_piece(timing_of(2.0, 5000));
  for (const Segment& s : segment_library(0.8, timing.seconds(0), timing.rate)) {
    const std::vector<double> wave = wave_of({s}, timing);
    const double most = std::abs(
        *std::max_element(wave.begin(), wave.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    EXPECT_LE(most, s.amplitude + 1e-12) << name_of(s.shape);
    if (s.shape == Shape::rest || s.shape == Shape::sweep) continue;  // a sweep's halves are not alike
    EXPECT_GT(most, 0.9 * s.amplitude) << name_of(s.shape) << " " << s.rate;
    EXPECT_LT(std::abs(sum(wave)), 0.02 * s.amplitude * static_cast<double>(wave.size())) << name_of(s.shape);
  }
}

TEST(Segments, FillTheTestBetweenRests) {
  for (const double seconds : {0.3, 1.0, 2.0, 30.0}) {
    const Timing timing = timing_of(seconds, 1000);
    const std::vector<double> wave = wave_of(std::vector<Segment>(timing.pieces(), {Shape::steps, 1.0, 10}), timing);
    ASSERT_EQ(wave.size(), static_cast<std::size_t>(std::lround(seconds * 1000)));
    for (std::size_t n = 0; n < wave.size(); ++n)
      EXPECT_EQ(wave[n] != 0, n >= timing.first.front() && n < timing.first.back()) << n << " of " << seconds << " s";
  }
}

TEST(Segments, ADrawIsOfItsSeed) {
  Random one(7), same(7), other(8);
  const Segment a = random_segment(one, 1.0, 0.25, 1000), b = random_segment(same, 1.0, 0.25, 1000);
  EXPECT_EQ(a.amplitude, b.amplitude);
  EXPECT_NE(a.amplitude, random_segment(other, 1.0, 0.25, 1000).amplitude);
  for (int i = 0; i < 100; ++i) {
    const Segment s = random_segment(one, 0.5, 0.25, 1000);
    EXPECT_LE(s.amplitude, 0.5);
    EXPECT_GT(s.amplitude, 0.0);
    EXPECT_GE(played_rate(s, 0.25), 4.0) << "one cycle at least";
  }
}

}  // namespace
}  // namespace servodx
