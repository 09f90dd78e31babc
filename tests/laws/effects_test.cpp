// What each effect does, against what its physics says.
#include <gtest/gtest.h>

#include <cmath>

#include "laws/bench.h"
#include "shipped_data.h"

namespace servodx {
namespace {

// A command that moves, on a valve of the shipped table.
Scenario stepped() {
  return made(0.4, 1e-3, [](double t) { return t < 0.1 ? 0.0 : t < 0.25 ? 4e-3 : -2e-3; });
}

template <class E>
ParameterVector with(int j, double value) {
  ParameterVector v = nominal_candidate();
  v[effect_row<E>(j)] = value;
  return v;
}

TEST(TransportDelay, WholeSamplesOfDelayShiftTheResponseByAsMany) {
  Scenario s = stepped();
  for (std::size_t k = 0; k < s.time.size(); ++k)
    s.command[k] = s.time[k] < 0.1 ? 0 : 3e-3 * std::sin(30 * (s.time[k] - 0.1));
  const Trajectory now = simulate(s, nominal_candidate(), all_signals());
  const Trajectory late = simulate(s, with<TransportDelay>(0, 5e-3), all_signals());
  const auto &a = of(now, Signal::spool_position), &b = of(late, Signal::spool_position);
  double largest = 0;
  for (std::size_t k = 110; k + 5 < a.size(); ++k) {
    largest = std::max(largest, std::abs(a[k]));
    EXPECT_NEAR(b[k + 5], a[k], 2e-3 * 1e-4) << k;  // the piston is not where it was: a trifle of flow force
  }
  EXPECT_GT(largest, 5e-5);
}

TEST(TransportDelay, HalfASampleLiesBetweenItsNeighbours) {
  Scenario s = stepped();
  for (std::size_t k = 0; k < s.time.size(); ++k) s.command[k] = 2e-3 * std::sin(40.0 * s.time[k]);
  const auto at = [&](double delay) {
    return of(simulate(s, with<TransportDelay>(0, delay), all_signals()), Signal::spool_position);
  };
  const auto none = at(0), half = at(2.5e-3), two = at(2e-3), three = at(3e-3);
  for (std::size_t k = 50; k < none.size(); ++k) EXPECT_NEAR(half[k], 0.5 * (two[k] + three[k]), 3e-8) << k;
}

TEST(ViscosityChange, DoublingItIsAnOilTwiceAsThick) {
  Scenario s = stepped(), thick = s;
  thick.oil.dynamic_viscosity *= 2, thick.oil.viscosity_ratio *= 2;
  const Trajectory a = simulate(thick, nominal_candidate(), all_signals());
  const Trajectory b = simulate(s, with<ViscosityChange>(0, 2.0), all_signals());
  for (Signal which : {Signal::spool_position, Signal::pressure_a, Signal::piston_position})
    for (std::size_t k = 0; k < s.time.size(); ++k)
      EXPECT_NEAR(of(a, which)[k], of(b, which)[k], 1e-6 * (std::abs(of(a, which)[k]) + 1e-9)) << k;
}

TEST(SupplyDroop, SteadySpeedCostsItsFlowTimesTheResistance) {
  // At a steady speed with no load the chambers follow: their sum is supply plus return less what droops.
  Scenario s = made(0.6, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 10e-3; });
  const ParameterVector v = with<SupplyDroop>(0, 1e10);
  const Trajectory dry = simulate(s, nominal_candidate(), all_signals()), wet = simulate(s, v, all_signals());
  ASSERT_TRUE(wet.ok);
  const auto speed = [&](const Trajectory& t) {
    const auto& x = of(t, Signal::piston_position);
    return (x[550] - x[450]) / (s.time[550] - s.time[450]);
  };
  const double area = 0.5 * (v[row::piston_area_a] + v[row::piston_area_b]);
  const double droop = 1e10 * area * speed(wet);
  EXPECT_LT(speed(wet), speed(dry));
  // Unloaded speed goes with the root of the pressure drop.
  const double drop = v[row::supply_pressure] - v[row::return_pressure];
  EXPECT_NEAR(speed(wet) / speed(dry), std::sqrt((drop - droop) / drop), 0.02);
}

TEST(MainsPickup, AddsItsLineAndMovesNothing) {
  const Scenario s = stepped();
  ParameterVector v = with<MainsPickup>(0, 3e-6);  // spool, cosine
  const Trajectory clean = simulate(s, nominal_candidate(), all_signals()), dirty = simulate(s, v, all_signals());
  for (std::size_t k = 0; k < s.time.size(); ++k) {
    const double line = 3e-6 * std::cos(2 * 3.14159265358979323846 * 50.0 * s.time[k]);
    EXPECT_NEAR(of(dirty, Signal::spool_position)[k] - of(clean, Signal::spool_position)[k], line, 1e-9);
    EXPECT_NEAR(of(dirty, Signal::pressure_a)[k], of(clean, Signal::pressure_a)[k], 1.0);
  }
}

TEST(SensorResponse, LagOfARampIsItsSlopeTimesTheTimeConstant) {
  Scenario s = made(0.6, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 10e-3 * (t - 0.05); });
  const Trajectory clean = simulate(s, nominal_candidate(), all_signals());
  const Trajectory lagged = simulate(s, with<SensorResponse>(1, 5e-3), all_signals());
  const auto &a = of(clean, Signal::spool_position), &b = of(lagged, Signal::spool_position);
  const double slope = (a[500] - a[400]) / 0.1;
  EXPECT_NEAR(a[500] - b[500], 5e-3 * slope, 0.05 * 5e-3 * slope);
}

TEST(Unexplained, AStraightCurveOfSpeedIsViscousFriction) {
  // Knots on a line in s with a scale far above the speed: s = v / scale.
  const Scenario s = stepped();
  ParameterVector shape = nominal_candidate(), friction = shape;
  const double scale = 100.0, extra = 500.0;  // [m/s], [N s/m]
  shape[effect_row<Unexplained>(0)] = Unexplained::piston;
  shape[effect_row<Unexplained>(1)] = Unexplained::piston_velocity;
  shape[effect_row<Unexplained>(3)] = scale;
  for (int k = 0; k < Unexplained::knots; ++k) shape[effect_row<Unexplained>(4 + k)] = -extra * scale * curve::node[k];
  friction[row::piston_viscous_friction] += extra;
  const Trajectory a = simulate(s, shape, all_signals()), b = simulate(s, friction, all_signals());
  ASSERT_TRUE(a.ok && b.ok);
  for (std::size_t k = 0; k < s.time.size(); ++k) {
    EXPECT_NEAR(of(a, Signal::pressure_a)[k], of(b, Signal::pressure_a)[k], 1e3) << k;
    EXPECT_NEAR(of(a, Signal::piston_position)[k], of(b, Signal::piston_position)[k], 1e-7) << k;
  }
}

}  // namespace
}  // namespace servodx
