// The oil of a log: what its temperature does to it, and where the model feels it.
#include <gtest/gtest.h>

#include <cmath>

#include "laws/bench.h"
#include "shipped_data.h"

namespace servodx {
namespace {

TEST(Oil, RowsHoldAt40DegreesAndWarmOilIsThinnerLighterAndSofter) {
  const Oil at_40 = oil_at(860, 14e-6, 313.15);
  EXPECT_NEAR(at_40.bulk_ratio, 1, 1e-12);
  EXPECT_NEAR(at_40.viscosity_ratio, 1, 1e-9);
  for (double t = 243.15; t < 363; t += 20) {
    const Oil cold = oil_at(860, 14e-6, t), warm = oil_at(860, 14e-6, t + 20);
    EXPECT_LT(warm.density, cold.density);
    EXPECT_LT(warm.viscosity_ratio, cold.viscosity_ratio);
    // Half a per cent a kelvin, the same at any temperature.
    EXPECT_NEAR(std::log(cold.bulk_ratio / warm.bulk_ratio) / 20, 5.5e-3, 1e-3);
  }
}

TEST(Oil, SofterOilIsARowOfSmallerBulkModulus) {
  Scenario s = made(0.3, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 8e-3; }), warm = s;
  warm.oil.bulk_ratio = 0.8;
  ParameterVector v = nominal_candidate(), soft = v;
  soft[row::bulk_modulus] *= 0.8;
  const Trajectory a = simulate(warm, v, all_signals()), b = simulate(s, soft, all_signals()),
                   stiff = simulate(s, v, all_signals());
  double apart = 0;
  for (Signal which : {Signal::spool_position, Signal::pressure_a, Signal::piston_position})
    for (std::size_t k = 0; k < s.time.size(); ++k) {
      EXPECT_NEAR(of(a, which)[k], of(b, which)[k], 1e-9 * (std::abs(of(a, which)[k]) + 1e-9)) << k;
      if (which == Signal::pressure_a) apart = std::max(apart, std::abs(of(a, which)[k] - of(stiff, which)[k]));
    }
  EXPECT_GT(apart, 1e4);  // [Pa]
}

}  // namespace
}  // namespace servodx
