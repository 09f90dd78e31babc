// The intervals of `tune` hold the truth as often as they say. A few seeds here; bench/twins.cpp runs twenty.
#include "recovery/twins.h"

#include <gtest/gtest.h>

#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx {
namespace {

TEST(Twins, MostIntervalsHoldTheTruth) {
  int inside = 0, stated = 0, dropped = 0;
  for (std::uint64_t seed = 101; seed <= 103; ++seed) {
    const twins::Twin twin = twins::make(8, seed, {"healthy/h01_steps_large", "healthy/h12_mixed"}, 1000);
    for (const twins::Outcome& o : twins::outcomes(twin, twins::tuned(twin, 0))) {
      stated += twins::identifiable(o);
      dropped += !twins::identifiable(o);
      inside += twins::identifiable(o) && std::abs(o.z) <= 1.96;
    }
  }
  std::printf("%d of %d inside, %d dropped\n", inside, stated, dropped);
  // Loose, as the number is small: it fails where the fit does not arrive or the errors are far too small.
  EXPECT_GE(stated, 18);
  EXPECT_GE(inside, stated * 3 / 4);
}

// Four laps, the null and the spool sensors' zeros move together without a trace in any log. So the laps' common shift
// is known as well as the zeros of two sensors are: 1 um each by their priors, 0.71 um of both. Small-step derivatives
// said 0.2 um.
TEST(Twins, CommonShiftOfTheLapsIsKnownAsWellAsTheSensorsZeros) {
  const twins::Twin twin = twins::make(15, 20, {"healthy/h01_steps_large", "healthy/h12_mixed"}, 2000);
  const TuneResult result = twins::tuned(twin, 0);
  int laps = 0;
  for (const ParameterResult& p : result.parameters)
    if (p.name.starts_with("lap_")) {
      EXPECT_NEAR(p.std_error, 1e-6 / std::sqrt(2.0), 0.1e-6) << p.name;
      ++laps;
    }
  EXPECT_EQ(laps, 4);
}

}  // namespace
}  // namespace servodx
