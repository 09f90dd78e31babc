// Oil in long lines: where it goes, what it weighs, and where it does nothing.
#include "effects/line_inertia.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "effects/registry.h"
#include "laws/bench.h"
#include "model/chamber.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

using Lined = Bench<LinedEffects>;
constexpr int line = n_base_states + LinedEffects::state_offset<LineInertia>();
enum { flow_a = line, chamber_a, flow_b, chamber_b };

ParameterVector with_lines(double inertance, double resistance, double loss) {
  ParameterVector v = nominal_candidate();
  v[effect_row<LineInertia>(0)] = inertance;
  v[effect_row<LineInertia>(1)] = resistance;
  v[effect_row<LineInertia>(2)] = loss;
  return v;
}

TEST(LineInertia, WhatLeavesTheValveIsStoredOrSwept) {
  // Against the same valve without lines, whose one chamber takes all that the edges let in.
  const ParameterVector v = with_lines(1e7, 1e8, 1e11);
  const Lined with(v), without(nominal_candidate());
  const double walls = 0.5 * v[row::hose_compliance];
  for (unsigned trial = 0; trial < 40; ++trial) {
    Random random(71, trial);
    auto y = with.state(random);
    for (int k = n_base_states; k < Lined::n; ++k) y[k] = 0;
    y[flow_a] = random.uniform(-1e-4, 1e-4), y[flow_b] = random.uniform(-1e-4, 1e-4);
    y[chamber_a] = random.uniform(1e6, 1e7), y[chamber_b] = random.uniform(1e6, 1e7);
    const auto u = with.inputs(random);
    const auto f = with.rate(y, u), g = without.rate(y, u);
    const Derived<double>& d = with.derived();
    const double volume_a = d.middle_volume_a + v[row::piston_area_a] * y[s_x_piston];
    const double volume_b = d.middle_volume_b - v[row::piston_area_b] * y[s_x_piston];
    const double leak = d.leak * (y[chamber_a] - y[chamber_b]), leak_at_taps = d.leak * (y[s_p_a] - y[s_p_b]);
    const auto balance = [&](int tap, int chamber, double volume, double area, double sign) {
      const double at_tap = f[tap] / chamber_stiffness(LineInertia::manifold, walls, y[tap], d);
      const double behind = f[chamber] / chamber_stiffness(volume, walls, y[chamber], d);
      const double edges = g[tap] / chamber_stiffness(volume, v[row::hose_compliance], y[tap], d) +
                           sign * (area * f[s_x_piston] + leak_at_taps);
      const double scale = std::abs(at_tap) + std::abs(behind) + std::abs(edges);
      EXPECT_NEAR(at_tap + behind + sign * (area * f[s_x_piston] + leak), edges, 1e-5 * scale) << trial;
    };
    balance(s_p_a, chamber_a, volume_a, v[row::piston_area_a], 1);
    balance(s_p_b, chamber_b, volume_b, v[row::piston_area_b], -1);
  }
}

TEST(LineInertia, DropAndInertiaTakeWhatTapAndChamberDifferBy) {
  const double inertance = 2e7, resistance = 3e8, loss = 4e11;
  const Lined bench(with_lines(inertance, resistance, loss));
  Random random(72, 0);
  auto y = bench.state(random);
  for (const double q : {-3e-4, 2e-4}) {
    y[flow_a] = q, y[chamber_a] = 4e6;
    const auto f = bench.rate(y, bench.inputs(random));
    EXPECT_NEAR(inertance * f[flow_a] + resistance * q + loss * q * std::abs(q), y[s_p_a] - y[chamber_a],
                1e-3 * std::abs(y[s_p_a] - y[chamber_a]));
  }
}

TEST(LineInertia, ColdOilDropsMoreInProportionToItsViscosity) {
  Oil thick;
  thick.viscosity_ratio = 5;
  const ParameterVector v = with_lines(2e7, 3e8, 0);
  const Lined usual(v), cold(v, thick);
  Lined::Y y{};
  y[s_p_a] = y[chamber_a] = y[s_p_b] = y[chamber_b] = 5e6, y[flow_a] = 1e-4;
  EXPECT_NEAR(cold.rate(y, {0, 2e7, 0, 0})[flow_a], 5 * usual.rate(y, {0, 2e7, 0, 0})[flow_a], 1e-9);
}

// Oil that hardly gives weighs on the piston as a mass of (inertance times area squared) a side.
TEST(LineInertia, BehindStiffOilItIsAMassOnThePiston) {
  const double inertance = 3e7;
  ParameterVector stiff = nominal_candidate();
  for (const int dry : {row::piston_coulomb_friction, row::piston_stribeck_friction})
    stiff[dry] = 0;  // no stick, no slip
  ParameterVector lines = stiff, mass = stiff;
  lines[effect_row<LineInertia>(0)] = inertance;
  lines[effect_row<LineInertia>(1)] = lines[effect_row<LineInertia>(2)] = 0;
  const double area_a = stiff[row::piston_area_a], area_b = stiff[row::piston_area_b];
  mass[row::moving_mass] += inertance * (area_a * area_a + area_b * area_b);
  const Scenario slow = made(0.4, 1e-3, [](double t) { return 6e-3 * std::sin(2 * M_PI * 8 * t); });
  const Trajectory by_lines = simulate(slow, lines, all_signals()), by_mass = simulate(slow, mass, all_signals()),
                   by_none = simulate(slow, stiff, all_signals());
  const auto& with_lines_on = of(by_lines, Signal::load_pressure);
  const auto& with_mass = of(by_mass, Signal::load_pressure);
  const auto& with_none = of(by_none, Signal::load_pressure);
  // Its own mode, undamped here, rings about what the mass does.
  double both = 0, by_itself = 0;
  for (std::size_t k = 100; k < with_mass.size(); ++k) {
    both += (with_lines_on[k] - with_none[k]) * (with_mass[k] - with_none[k]);
    by_itself += (with_mass[k] - with_none[k]) * (with_mass[k] - with_none[k]);
  }
  std::printf("load pressure: lines do %.3f of what the mass does\n", both / by_itself);
  EXPECT_NEAR(both / by_itself, 1, 0.1);
}

// Half way along stands the mean of both ends, and what a log calls the load pressure is between the taps.
TEST(LineInertia, PressuresAreMeasuredWhereTheTapsSit) {
  const Scenario steps = made(0.1, 2e-4, [](double t) { return t < 0.02 ? 0.0 : 8e-3; });
  const auto at = [&](double along) {
    ParameterVector v = with_lines(2e7, 3e8, 4e11);
    v[effect_row<LineInertia>(3)] = along;
    return simulate(steps, v, all_signals());
  };
  const Trajectory valve = at(0), middle = at(0.5), cylinder = at(1);
  double apart = 0;
  for (const Signal s : {Signal::pressure_a, Signal::pressure_b})
    for (std::size_t k = 0; k < steps.time.size(); ++k) {
      const double v = of(valve, s)[k], c = of(cylinder, s)[k];
      EXPECT_NEAR(of(middle, s)[k], 0.5 * (v + c), 1e-6 * std::abs(v)) << k;
      apart = std::max(apart, std::abs(v - c));
    }
  EXPECT_GT(apart, 1e5) << "a step in these lines takes more than a bar";
  for (std::size_t k = 0; k < steps.time.size(); ++k) {
    EXPECT_EQ(of(valve, Signal::piston_position)[k], of(cylinder, Signal::piston_position)[k]) << k;
    EXPECT_NEAR(of(cylinder, Signal::load_pressure)[k],
                of(cylinder, Signal::pressure_a)[k] - of(cylinder, Signal::pressure_b)[k], 1e-6);
  }
}

TEST(LineInertia, WithoutALineItsTapsAreTheChambers) {
  const Scenario steps = made(0.1, 1e-3, [](double t) { return t < 0.02 ? 0.0 : 8e-3; });
  ParameterVector v = nominal_candidate();
  const Trajectory none = simulate(steps, v, all_signals());
  v[effect_row<LineInertia>(3)] = 1;
  EXPECT_EQ(of(simulate(steps, v, all_signals()), Signal::pressure_a), of(none, Signal::pressure_a));
}

TEST(LineInertia, ShortLinesAreNone) {
  const Scenario steps = made(0.2, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 8e-3; });
  const Trajectory none = simulate(steps, nominal_candidate(), all_signals());
  const Trajectory tiny = simulate(steps, with_lines(1.0, 0, 0), all_signals());
  const auto &x = of(none, Signal::piston_position), &y = of(tiny, Signal::piston_position);
  const double travel = std::abs(x.back() - x.front());
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(y[k], x[k], 0.01 * travel) << k;
}

}  // namespace
}  // namespace servodx
