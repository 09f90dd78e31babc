// Readings of valves with wear of known size, and what they are worth to another valve.
#include "prognose/seeded.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "base/error.h"
#include "base/random.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"
#include "prognose/valve_history.h"
#include "store/seeded_csv.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

constexpr double healthy = 3e-6, failed = 30e-6;

// A clearance as a model may read it: a quarter of the way it is read too small by two fifths, in thick oil by three;
// valves differ in size by a twentieth.
double reading(double truth, double kelvin, double size, double dips = 1) {
  const double part = (truth - healthy) / (failed - healthy);
  const double dip = dips * std::clamp(0.4 + 0.1 * log_viscosity(kelvin), 0.3, 0.6);
  return size * truth * (1 - dip * std::max(0.0, 1 - std::abs(part - 0.25) / 0.25));
}

std::vector<SeededReading> a_test(std::uint64_t seed, int valves = 8, double dips = 1) {
  Random random(seed, 41);
  std::vector<SeededReading> test;
  for (int v = 0; v < valves; ++v) {
    const double size = 1 + 0.05 * random.normal();
    for (const double part : {0.0, 0.125, 0.25, 0.5, 0.75, 1.0})
      for (const double celsius : {-25.0, 0.0, 25.0, 60.0}) {
        const double truth = healthy + part * (failed - healthy), kelvin = celsius + 273.15;
        test.push_back({"parameter:22", std::to_string(v), truth,
                        reading(truth, kelvin, size, dips) + 0.1e-6 * random.normal(), log_viscosity(kelvin)});
      }
  }
  return test;
}

TEST(Seeded, AnotherValvesWearLiesWhereTheTestSaysAndAsNear) {
  int within = 0, n = 0;
  double square = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const ReadingCurve curve(a_test(seed), {});
    Random random(seed, 42);
    const double size = 1 + 0.05 * random.normal();
    for (const double part : {0.5, 0.75, 1.0}) {
      const double truth = healthy + part * (failed - healthy), kelvin = random.uniform(248, 333);
      const double off = curve.at(reading(truth, kelvin, size), log_viscosity(kelvin)).truth - truth;
      ++n, within += std::abs(off) < 1.645 * curve.spread(truth);
      square += std::pow(off / truth, 2);
    }
  }
  EXPECT_GT(within, 0.82 * n);
  EXPECT_LT(within, 0.97 * n);
  EXPECT_LT(std::sqrt(square / n), 0.075);
}

TEST(Seeded, ValvesDifferInSizeByWhatTheTestSays) {
  double size = 0, tilt = 0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto differing = ReadingCurve(a_test(seed, 12, 0), {}).differing();
    ASSERT_TRUE(differing);
    size += differing->size / 10, tilt += differing->tilt / 10;
  }
  EXPECT_NEAR(size, 0.06, 0.015);  // 0.05, and Student's factor and the mean's own error for twelve
  EXPECT_LT(tilt, 0.02);
}

ValveHistory a_life(std::uint64_t seed) {
  ValveHistory h;
  h.valve = "v";
  Random random(seed, 43);
  for (int k = 0; k < 21; ++k) {
    Recording r;
    r.at = 3 * k, r.table_sha256 = "a", r.temperature = random.uniform(248, 333);
    const double v = reading(healthy + (failed - healthy) * k / 40, r.temperature, 1) + 0.1e-6 * random.normal();
    r.checks.push_back({"parameter:22", v, 0.1e-6, "m", v, 1, ""});
    h.recordings.push_back(r);
  }
  return h;
}

// Readings that dip half way look like a late onset and a steep growth: the end is told a tenth and more too early.
TEST(Seeded, AReadingThatDipsIsNoLateOnset) {
  TrendSettings options;
  options.failure["parameter:22"].second = failed;
  double with = 0, without = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    options.seeded.clear();
    const ValveTrend before = trend(a_life(seed), options);
    options.seeded = a_test(seed);
    const ValveTrend after = trend(a_life(seed), options);
    ASSERT_TRUE(before.remaining && after.remaining);
    without += std::abs(before.remaining->median / 60 - 1) / 6, with += std::abs(after.remaining->median / 60 - 1) / 6;
  }
  EXPECT_LT(with, 0.1);
  EXPECT_LT(with, 0.6 * without);
}

TEST(Seeded, AFileThatCannotServeIsRefusedWithItsPlaceAndMend) {
  const TemporaryFolder folder;
  const std::string path = folder / "test.csv", head = "valve,name,truth,value,oil_temperature [degC],unit\n";
  const auto said = [&](const std::string& text) -> std::string {
    std::ofstream(path) << text;
    try {
      read_seeded_csv(path);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string good = "a,parameter:22,3e-6,2.9e-6,40,m\na,parameter:22,3e-5,2.8e-5,40,m\na,fidelity,,1.3,40,1\n";
  EXPECT_EQ(said(head + good), "");
  EXPECT_NE(said("valve,name,value,oil_temperature [degC]\n").find(":1: column 'truth'"), std::string::npos);
  EXPECT_NE(said(head + good + "a,parameter:22,x,2e-6,40,m\n").find(":5: column 'truth': 'x'"), std::string::npos);
  EXPECT_NE(said(head + good + "a,parameter:22,3e-6,2e-6,40\n").find(":5: has 5 cells"), std::string::npos);
  EXPECT_NE(said(head + good + "a,parameter:22,3e-6,2e-6,-20,m\n").find("every size at every oil"), std::string::npos);
  EXPECT_NE(said(head + "a,parameter:22,3e-6,2e-6,40,m\n").find("two sizes"), std::string::npos);
  EXPECT_NE(said(head + good + "a,fidelity,1,2,40,1\n").find("no tracked parameter"), std::string::npos);
}

}  // namespace
}  // namespace servodx
