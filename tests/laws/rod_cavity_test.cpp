// The third chamber of the actuator: what it adds and what it must not change.
#include "effects/rod_cavity.h"

#include <gtest/gtest.h>

#include "base/random.h"
#include "base/smooth.h"
#include "effects/registry.h"
#include "laws/bench.h"
#include "model/chamber.h"
#include "model/derivative.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

ParameterVector with_cavity(double area, double lag) {
  ParameterVector v = nominal_candidate();
  v[effect_row<RodCavity>(0)] = area;
  v[effect_row<RodCavity>(1)] = 0.02;
  v[effect_row<RodCavity>(2)] = lag;
  return v;
}

using Everything = Bench<AllEffects>;
constexpr int cavity = n_base_states + AllEffects::state_offset<RodCavity>();

TEST(RodCavity, OilThatEntersItLeftChamberA) {
  // dp/dt of chamber A times its compliance, with and without: the difference is what the cavity and its area take.
  constexpr double area = 1e-4;
  const ParameterVector on = with_cavity(area, 2e-3), off = with_cavity(0.0, 2e-3);
  const Everything with(on), without(off);
  for (unsigned trial = 0; trial < 40; ++trial) {
    Random random(61, trial);
    auto y = with.state(random), rest = y;
    for (int k = n_base_states; k < Everything::n; ++k) y[k] = rest[k] = 0;
    const double pressure = random.uniform(0, 2e7);
    y[cavity] = area * pressure / with.p(row::bulk_modulus);
    const auto u = with.inputs(random);
    const auto f = with.rate(y, u), g = without.rate(rest, u);
    const double length = soft_positive(0.02 + 0.5 * with.p(row::piston_stroke) + y[s_x_piston], RodCavity::shortest);
    // Oil stored in the cavity: its compressed column and the room that the core leaves.
    const double stored = length * f[cavity] + area * f[s_x_piston];
    const double volume =
        with.p(row::dead_volume_a) + with.p(row::piston_area_a) * (0.5 * with.p(row::piston_stroke) + y[s_x_piston]);
    const double compliance = 1.0 / chamber_stiffness(volume, with.p()[row::hose_compliance], y[s_p_a], with.derived());
    const double from_a = area * f[s_x_piston] - compliance * (f[s_p_a] - g[s_p_a]);
    EXPECT_NEAR(stored, from_a, 1e-3 * std::abs(from_a) + 1e-9 * std::abs(compliance * f[s_p_a])) << trial;
    EXPECT_NEAR(f[s_v_piston] - g[s_v_piston], area * (pressure - y[s_p_a]) / with.p(row::moving_mass),
                1e-9 * std::abs(f[s_v_piston]) + 1e-6)
        << trial;
  }
}

TEST(RodCavity, ASlowOneHoldsThePistonBackAndAFastOneDoesNot) {
  const auto speed = [](double area, double lag) {
    const Scenario s = made(0.4, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 0.01; });
    const Trajectory t = simulate(s, with_cavity(area, lag));
    EXPECT_TRUE(t.ok);
    const auto& x = of(t, Signal::piston_position);
    return (x.back() - x[x.size() - 100]) / 0.1;
  };
  const double base = speed(0.0, 1e-3);
  // Filling it takes 9 bar on 1 cm2: 90 N of some 8000 that the edges have left.
  EXPECT_NEAR(speed(1e-4, 1e-4), base, 0.006 * base);
  EXPECT_LT(speed(1e-4, 5e-2), 0.98 * base);
}

}  // namespace
}  // namespace servodx
