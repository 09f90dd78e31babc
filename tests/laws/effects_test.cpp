// What each effect does, against what its physics says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

#include "base/random.h"
#include "effects/armature_angle.h"
#include "effects/edge_transition.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mains_pickup.h"
#include "effects/mount_compliance.h"
#include "effects/nozzle_land.h"
#include "effects/nozzle_mismatch.h"
#include "effects/oil_stiffening.h"
#include "effects/orifice_length.h"
#include "effects/pressure_viscosity.h"
#include "effects/registry.h"
#include "effects/return_drop.h"
#include "effects/sampled_lag.h"
#include "effects/screen_drop.h"
#include "effects/seal_film.h"
#include "effects/seal_shear.h"
#include "effects/sensor_response.h"
#include "effects/stiction.h"
#include "effects/supply_droop.h"
#include "effects/transport_delay.h"
#include "effects/unexplained.h"
#include "effects/viscosity_change.h"
#include "effects/viscosity_slope.h"
#include "laws/bench.h"
#include "model/asperities.h"
#include "model/chamber.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/hooks.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

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

TEST(EdgeTransition, CostsAnOpenEdgeAFlowThatGrowsWithViscosityAndNotWithTheOpening) {
  // dp = rho / 2 (v / Cd)^2 + 12 mu L v / h: to first order the flow w h v is less by 12 mu L w Cd^2 / rho at any h.
  const double more = 45.0, length = more / EdgeTransition::per_length, cd = constants::cd_metering;
  const auto lost = [&](double current, double thicker) {
    Scenario s = made(0.6, 1e-3, [&](double t) { return t < 0.05 ? 0.0 : current; });
    s.oil.dynamic_viscosity *= thicker;
    const auto speed = [&](double added) {
      ParameterVector v = with<EdgeTransition>(0, EdgeTransition::parameters[0].off + added);
      v[row::flow_force_coefficient] = 0;  // slower jets push less, and the spool would open further
      const Trajectory t = simulate(s, v, all_signals());
      const auto& x = of(t, Signal::piston_position);
      return (x[550] - x[450]) / (s.time[550] - s.time[450]);
    };
    const ParameterVector v = nominal_candidate();
    const double first_order =
        12 * s.oil.dynamic_viscosity * length * v[row::port_width] * cd * cd / s.oil.density / v[row::piston_area_a];
    return (speed(0) - speed(more)) / first_order;
  };
  for (const double current : {4e-3, 10e-3})
    for (const double thicker : {1.0, 3.0}) {
      std::printf("%.0f mA, viscosity x%.0f: %.3f of the first order\n", 1e3 * current, thicker,
                  lost(current, thicker));
      EXPECT_NEAR(lost(current, thicker), 1.0, 0.1);
    }
}

// At rest both sides pass q: (2q / G_f)^2 + (q / G_o)^2 + (q / G_n)^2 + (laminar + land) q = supply less return, where
// `land` [Pa s/m3] is what the nozzles take of the laminar part.
void expect_pilot_pressures_at_rest(const Scenario& s, const ParameterVector& v, const Derived<double>& d,
                                    double laminar, double land = 0) {
  const double gap = v[row::nozzle_gap], nozzle = d.nozzle_conductance * gap / std::sqrt(1 + d.bore_loss * gap * gap);
  const double square = 4 / (d.filter_conductance * d.filter_conductance) +
                        1 / (d.orifice_conductance * d.orifice_conductance) + 1 / (nozzle * nozzle);
  const double drop = v[row::supply_pressure] - v[row::return_pressure];
  const double whole = laminar + land, q = 2 * drop / (whole + std::sqrt(whole * whole + 4 * square * drop));
  const double expected = v[row::return_pressure] + q * q / (nozzle * nozzle) + land * q;
  const Trajectory t = simulate(s, v, all_signals());
  ASSERT_TRUE(t.ok);
  for (Signal side : {Signal::pilot_pressure_1, Signal::pilot_pressure_2})
    EXPECT_NEAR(of(t, side).back(), expected, 1e-3 * drop);
}

TEST(OrificeLength, PilotPressureAtRestIsThatOfPoiseuilleInSeriesWithJets) {
  for (const double slenderness : {0.0, 3.0})
    for (const double thicker : {1.0, 10.0}) {
      SCOPED_TRACE(testing::Message() << slenderness << " diameters, viscosity times " << thicker);
      Scenario s = made(0.2, 1e-3, [](double) { return 0.0; });
      s.oil.dynamic_viscosity *= thicker;
      ParameterVector v = with<OrificeLength>(0, slenderness);
      v[row::servovalve_null] = 0;
      const double cube = std::pow(v[row::fixed_orifice_diameter], 3);
      expect_pilot_pressures_at_rest(s, v, derive<double>(v.data(), s.oil),
                                     128 * s.oil.dynamic_viscosity * slenderness / (constants::pi * cube));
    }
}

TEST(OrificeLength, ColdOilCostsASlewItsSpeedOnlyWithALength) {
  const auto fastest = [](double slenderness, double thicker) {
    Scenario s = made(0.2, 1e-4, [](double t) { return t < 0.05 ? -20e-3 : 20e-3; });
    s.oil.dynamic_viscosity *= thicker;
    const Trajectory t = simulate(s, with<OrificeLength>(0, slenderness), all_signals());
    const auto& x = of(t, Signal::spool_position);
    double v = 0;
    for (std::size_t k = 5; k < x.size(); ++k) v = std::max(v, (x[k] - x[k - 5]) / 5e-4);
    return v;
  };
  const double thin = fastest(0, 1), sharp = fastest(0, 10), tube = fastest(2, 10), capillary = fastest(5, 10);
  std::printf("slew %.1f mm/s; in oil ten times as thick %.1f, with a length of 2 diameters %.1f, of 5 %.1f\n",
              1e3 * thin, 1e3 * sharp, 1e3 * tube, 1e3 * capillary);
  EXPECT_NEAR(sharp, thin, 0.01 * thin);
  EXPECT_LT(tube, 0.97 * sharp);
  EXPECT_LT(capillary, 0.97 * tube);
}

TEST(NozzleLand, PilotPressureAtRestIsThatOfSlotAndJetsInSeries) {
  for (const double width : {0.0, 6e-5})
    for (const double thicker : {1.0, 5.0}) {
      SCOPED_TRACE(testing::Message() << width << " m, viscosity times " << thicker);
      Scenario s = made(0.2, 1e-3, [](double) { return 0.0; });
      s.oil.dynamic_viscosity *= thicker;
      ParameterVector v = with<NozzleLand>(0, width);
      v[row::servovalve_null] = 0;
      const double bore = v[row::hydraulic_amplifier_gain] / constants::pi, gap = v[row::nozzle_gap];
      expect_pilot_pressures_at_rest(
          s, v, derive<double>(v.data(), s.oil), 0,
          12 * s.oil.dynamic_viscosity * width / (constants::pi * (bore + width) * std::pow(gap, 3)));
    }
}

TEST(NozzleMismatch, PilotIsInBalanceWhereTheFlapperMakesUpForIt) {
  // (1 + q) (g - x) = (1 - q) (g + x) at x = q g.
  constexpr double excess = 0.03;
  const ParameterVector v = with<NozzleMismatch>(0, excess);
  const Bench<AllEffects> bench(v);
  const auto apart = [&](double travel) {
    Bench<AllEffects>::Y y{};
    y[s_x_flapper] = travel * v[row::nozzle_gap];
    y[s_p_filter] = 20e6, y[s_p_pilot_1] = y[s_p_pilot_2] = 10e6, y[s_p_a] = y[s_p_b] = 10e6;
    const auto rate = bench.rate(y, {0, v[row::supply_pressure], v[row::return_pressure], 0});
    return rate[s_p_pilot_1] - rate[s_p_pilot_2];
  };
  EXPECT_LT(apart(0), 0);  // nozzle 1 lets more go
  EXPECT_NEAR(apart(excess), 0, 0.02 * std::abs(apart(0)));
}

TEST(NozzleMismatch, SpoolSlewsFasterOutThroughTheNozzleThatPassesMore) {
  const auto slew = [](double excess, double current) {
    Scenario s = made(0.06, 1e-4, [&](double t) { return t < 0.03 ? -current : current; });
    const Trajectory t = simulate(s, with<NozzleMismatch>(0, excess), all_signals());
    const auto& x = of(t, Signal::spool_position);
    double fastest = 0;
    for (std::size_t k = 305; k < x.size(); ++k) fastest = std::max(fastest, std::abs(x[k] - x[k - 5]) / 5e-4);
    return fastest;
  };
  const double to_2 = slew(0.05, 20e-3), to_1 = slew(0.05, -20e-3), alike = slew(0, 20e-3);
  std::printf("%.1f and %.1f mm/s, %.1f where alike\n", 1e3 * to_2, 1e3 * to_1, 1e3 * alike);
  // Positive current closes nozzle 1; the spool pushes what it displaces through nozzle 2, which passes less.
  EXPECT_LT(to_2, alike);
  EXPECT_GT(to_1, alike);
  EXPECT_NEAR(slew(-0.05, 20e-3), to_1, 1e-3 * alike);
}

TEST(MountCompliance, NewtonsLawHoldsForTheBody) {
  Random random(91, 1);
  const double compliance = 2e-7, relaxation = 3e-4, mass = 12;
  ParameterVector v = nominal_candidate();
  v[effect_row<MountCompliance>(0)] = compliance, v[effect_row<MountCompliance>(1)] = relaxation,
  v[effect_row<MountCompliance>(2)] = mass;
  const Bench<AllEffects> bench(v);
  constexpr int at = n_base_states + AllEffects::state_offset<MountCompliance>();
  for (int k = 0; k < 20; ++k) {
    auto y = bench.state(random);
    y[at] = random.uniform(-1e-3, 1e-3), y[at + 1] = random.uniform(-0.1, 0.1);
    const auto rate = bench.rate(y, bench.inputs(random));
    const double force = v[row::piston_area_a] * y[s_p_a] - v[row::piston_area_b] * y[s_p_b];
    const double expected = -(force + y[at] / compliance + relaxation / compliance * y[at + 1]) / mass;
    EXPECT_EQ(rate[at], y[at + 1]);
    EXPECT_NEAR(rate[at + 1], expected, 1e-3 * std::abs(expected));  // the little that keeps a body without mass finite
  }
}

// Two cylinders on one rod, side by side, are one of twice the area: twice the oil's spring and twice the mass ring at
// the same frequency on a mount that is as many times as stiff.
TEST(MountCompliance, TwiceTheRigHasAMountOfTwiceTheStiffnessAndABodyOfTwiceTheMass) {
  const ParameterVector one = nominal_candidate();
  ParameterVector two = one;
  for (const int at :
       {row::piston_area_a, row::piston_area_b, row::dead_volume_a, row::dead_volume_b, row::moving_mass})
    two[static_cast<std::size_t>(at)] *= 2;
  std::array<double, 3> own_one{}, own_two{};
  MountCompliance::as_large_as_rig(own_one.data(), one.data());
  MountCompliance::as_large_as_rig(own_two.data(), two.data());
  EXPECT_DOUBLE_EQ(own_two[0], 0.5 * own_one[0]);
  EXPECT_DOUBLE_EQ(own_two[2], 2 * own_one[2]);
  EXPECT_EQ(own_one[2], one[row::moving_mass]);
}

TEST(MountCompliance, ABodyWithoutMassGoesWhereItsLossLetsIt) {
  Random random(92, 1);
  const double compliance = 2e-7, relaxation = 3e-4;
  ParameterVector v = nominal_candidate();
  v[effect_row<MountCompliance>(0)] = compliance, v[effect_row<MountCompliance>(1)] = relaxation,
  v[effect_row<MountCompliance>(2)] = 0;
  const Bench<AllEffects> bench(v);
  constexpr int at = n_base_states + AllEffects::state_offset<MountCompliance>();
  auto y = bench.state(random);
  const auto u = bench.inputs(random);
  for (int k = 0; k < 200; ++k) bench.step(y, u, 1e-6);
  const double force = v[row::piston_area_a] * y[s_p_a] - v[row::piston_area_b] * y[s_p_b];
  const double expected = -(y[at] + compliance * force) / relaxation;
  EXPECT_NEAR(y[at + 1], expected, 1e-2 * std::abs(expected));
}

TEST(ScreenDrop, PilotPressureAtRestIsThatOfPoresAndJetsInSeries) {
  // The pores of a filter take drop times the ratio of viscosities at its own flow at rest, less of them the more.
  for (const double viscous : {0.0, 4e5})
    for (const double thicker : {1.0, 20.0})
      for (const double blocked : {0.0, 0.7}) {
        SCOPED_TRACE(testing::Message() << viscous << " Pa, viscosity times " << thicker << ", blocked " << blocked);
        Scenario s = made(0.2, 1e-3, [](double) { return 0.0; });
        s.oil.dynamic_viscosity *= thicker, s.oil.viscosity_ratio *= thicker;
        ParameterVector v = with<ScreenDrop>(0, viscous);
        v[row::servovalve_null] = 0;
        v[row::filter_blockage_positive] = v[row::filter_blockage_negative] = blocked;
        const Derived<double> d = derive<double>(v.data(), s.oil);
        const double at_rest = std::sqrt(0.5 * v[row::supply_pressure]) / constants::clean_filter_area_ratio;
        expect_pilot_pressures_at_rest(s, v, d, viscous * s.oil.viscosity_ratio / at_rest * 2 / d.filter_conductance);
      }
}

// The piston at a steady speed: what the pressures carry there is the friction, as nothing else loads it.
struct Steady {
  double speed = 0, force = 0;  // [m/s], [N]
};
Steady steady(const ParameterVector& v, double current, double thicker = 1) {
  Scenario s = made(1.0, 1e-3, [&](double t) { return t < 0.05 ? 0.0 : current; });
  s.oil.viscosity_ratio *= thicker;
  const Trajectory t = simulate(s, v, all_signals());
  EXPECT_TRUE(t.ok);
  const auto& x = of(t, Signal::piston_position);
  Steady out{(x[950] - x[750]) / (s.time[950] - s.time[750])};
  for (std::size_t k = 750; k < 950; ++k)
    out.force +=
        (v[row::piston_area_a] * of(t, Signal::pressure_a)[k] - v[row::piston_area_b] * of(t, Signal::pressure_b)[k]) /
        200;
  return out;
}

TEST(SealShear, ItsShareOfTheViscousFrictionGrowsWithTheViscosityAndTheRestWithItsRoot) {
  constexpr double viscous = 1e4;  // [N s/m]
  for (const double share : {0.0, 0.6, 1.0})
    for (const double thicker : {1.0, 4.0}) {
      ParameterVector v = with<SealShear>(0, share);
      v[row::piston_viscous_friction] = viscous;
      v[row::piston_coulomb_friction] = v[row::piston_stribeck_friction] = 0;
      const Steady run = steady(v, 1e-3, thicker);
      const double expected = viscous * ((1 - share) * std::sqrt(thicker) + share * thicker);
      EXPECT_NEAR(run.force / run.speed, expected, 0.01 * expected) << share << ", " << thicker;
    }
}

TEST(SealShear, TheOilLeavesTheDryShareAlone) {
  const auto drag = [](double viscosity_ratio, double dry) {
    ParameterVector v = with<SealShear>(1, dry);
    Oil oil;
    oil.viscosity_ratio = viscosity_ratio;
    return derive<double, AllEffects>(v.data(), oil).viscous / v[row::piston_viscous_friction];
  };
  EXPECT_NEAR(drag(9.0, 1.0), 1.0, 1e-12);
  EXPECT_NEAR(drag(9.0, 0.5), 2.0, 1e-12);  // half of it as the root, 3
  EXPECT_NEAR(drag(1.0, 0.5), 1.0, 1e-12);
}

TEST(SealFilm, AtItsSpeedHalfOfTheBreakawayFrictionIsLeft) {
  // What is left of the breakaway friction stands beside all else.
  const auto force = [](double breakaway, double film_speed, double current, double* speed) {
    ParameterVector v = with<SealFilm>(0, film_speed);
    v[row::piston_stribeck_friction] = breakaway;
    v[row::piston_viscous_friction] = 1e4;  // well damped
    const Steady run = steady(v, current);
    *speed = run.speed;
    return run.force;
  };
  double speed = 0, other = 0;
  const double without = force(0, 8e-3, 3e-3, &speed);
  for (const double film : {speed, 3 * speed}) {
    const double left = (force(200, film, 3e-3, &other) - without) / 200;
    const double ratio = other / film;
    std::printf("%.1f mm/s, film at %.1f: %.3f left\n", 1e3 * other, 1e3 * film, left);
    EXPECT_NEAR(left, 1 / (1 + ratio * ratio), 0.03);
  }
}

TEST(SealFilm, FrictionFollowsASpeedOverTheWayOnWhichContactsAreRenewed) {
  for (const double speed : {5e-3, 0.1}) {
    constexpr double per_film_speed = 1 / 8e-3, step = 1e-7;
    FrictionMemory<double> m;
    m.rest(0, 0);
    double x = 0;
    while (x < constants::seal_renewal)
      m.move(0, 0, x, x + step, step / speed, constants::spool_presliding, {2, per_film_speed}), x += step;
    const double steady = stribeck(speed, per_film_speed);
    EXPECT_NEAR(m.seal_breakaway, steady + (1 - steady) * std::exp(-1.0), 2e-3);
  }
}

TEST(SealFilm, SlowPistonCreepsOnFallingFriction) {
  ParameterVector v = with<SealFilm>(0, 8e-3);
  v[row::piston_stribeck_friction] = 250;
  const Scenario s = made(1.5, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 0.35e-3; });
  const Trajectory t = simulate(s, v, all_signals());
  ASSERT_TRUE(t.ok);
  const auto& x = of(t, Signal::piston_position);
  double least = 1, most = 0;
  for (std::size_t k = 1000; k < 1490; ++k) {
    const double speed = (x[k + 2] - x[k]) / (s.time[k + 2] - s.time[k]);
    least = std::min(least, speed), most = std::max(most, speed);
  }
  std::printf("%.2f to %.2f mm/s\n", 1e3 * least, 1e3 * most);
  EXPECT_GT(least, 1e-3);
  EXPECT_LT(most, 8e-3);  // below the film's speed, where friction falls
  EXPECT_LT(most, 1.2 * least);
}

// A spool held by 20 N, and a way over which that is taken up.
ParameterVector held(double yield) {
  ParameterVector v = with<Stiction>(1, yield);
  v[row::spool_friction] = 20.0;
  return v;
}

// What holds it is a spring up to there: force over the spool's area is in proportion to motor less wire.
TEST(Stiction, ACurrentThatDoesNotFreeTheSpoolMovesItAsItsFrictionYields) {
  constexpr double current = 2e-4;
  const Scenario s = made(0.3, 1e-3, [](double t) { return t < 0.05 ? 0.0 : current; });
  const auto given = [&](double yield) {  // [m/N] at the ball
    const ParameterVector v = held(yield);
    const auto x = of(simulate(s, v, all_signals()), Signal::spool_position);
    const double moved = x.back() - x.front();
    EXPECT_LT(std::abs(moved), constants::spool_presliding + yield) << "it slips";
    return moved / (v[row::torque_motor_gain] * current - v[row::feedback_wire_stiffness] * moved);
  };
  EXPECT_NEAR(given(6e-6) / given(0.0), (constants::spool_presliding + 6e-6) / constants::spool_presliding, 0.1);
}

TEST(Stiction, OnceItSlidesFrictionIsWhatItWasHoweverFarItYielded) {
  const Scenario s = made(0.6, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 8e-3 * (t - 0.05) / 0.55; });
  const auto end = [&](const ParameterVector& v) {
    return of(simulate(s, v, all_signals()), Signal::spool_position).back();
  };
  const double stiff = end(held(0.0)), soft = end(held(6e-6)), without = end(nominal_candidate());
  EXPECT_GT(without - stiff, 1e-6) << "friction holds it back";
  EXPECT_NEAR(soft, stiff, 0.05 * (without - stiff));
}

// Walther's law (ASTM D341): a straight line of lg lg (nu + 0.7) over lg T.
TEST(Oil, AViscosityAt100DegreesIsMetAndMakesAnOilThinInTheHeatThickInTheCold) {
  const auto viscosity = [](double kelvin, double at_100) {
    const Oil oil = oil_at(860, 14e-6, kelvin, at_100);
    return oil.dynamic_viscosity / oil.density;
  };
  for (const double at_100 : {5.1e-6, 3.5e-6}) EXPECT_NEAR(viscosity(373.15, at_100), at_100, 1e-12);
  EXPECT_NEAR(viscosity(313.15, 3.5e-6), 14e-6, 1e-12);
  EXPECT_GT(viscosity(253.15, 3.5e-6), 3 * viscosity(253.15, 5.1e-6));
}

TEST(Oil, AFreedSlopeIsTheLawsOfAnOilOfThatSlope) {
  // The slopes of two oils by their own viscosities at 100 degC; the one over the other is the effect's number.
  const auto slope = [](double at_100) {
    const auto w = [](double nu) { return std::log10(std::log10(nu * 1e6 + 0.7)); };
    return (w(14e-6) - w(at_100)) / std::log10(373.15 / 313.15);
  };
  const double flat = 5.1e-6, steep = 3.5e-6, ratio = slope(steep) / slope(flat), none = 1.0;
  for (const double kelvin : {243.15, 273.15, 313.15, 353.15}) {
    const Oil oil = oil_at(860, 14e-6, kelvin, flat), meant = oil_at(860, 14e-6, kelvin, steep);
    EXPECT_NEAR(ViscositySlope::viscosity(&ratio, oil) * oil.dynamic_viscosity / meant.dynamic_viscosity, 1.0, 1e-9);
    EXPECT_EQ(ViscositySlope::viscosity(&none, oil), 1.0);
  }
}

TEST(Oil, ColdOilIsStifferByHalfAPerCentAKelvin) {
  const Oil cold = oil_at(860, 14e-6, 303.15), hot = oil_at(860, 14e-6, 323.15), at_40 = oil_at(860, 14e-6, 313.15);
  EXPECT_NEAR(at_40.stiffness_ratio, 1.0, 1e-12);
  EXPECT_NEAR(std::log(cold.stiffness_ratio / hot.stiffness_ratio) / 20.0, 5.5e-3, 1e-4);
  // A blocked piston: the load pressure's mode, and with it a chamber's stiffness, follows the oil's.
  ParameterVector v = nominal_candidate();
  v[row::air_fraction] = 0, v[row::hose_compliance] = 0;
  const auto stiffness = [&](const Oil& oil) {
    const Derived<double> d = derive<double>(v.data(), oil);
    return chamber_stiffness(1e-4, v[row::hose_compliance], 7e6, d);
  };
  EXPECT_NEAR(stiffness(cold) / stiffness(hot), cold.stiffness_ratio / hot.stiffness_ratio, 1e-6);
}

// Of an open edge: flow over its turbulent limit, where the laminar drop at that limit is `share` of the turbulent one.
double coefficient(double abruptness, double share, double fading = 0) {
  ParameterVector v = with<EdgeTransition>(1, abruptness);
  v[effect_row<EdgeTransition>(2)] = fading;
  const Derived<double> d = derive<double, AllEffects>(v.data(), Oil{});
  constexpr double opening = 1e-4;
  const double h = std::hypot(2 * opening, std::sqrt(d.clearance2)), r = d.slot_corner / (1 + abruptness) / h;
  const double dp = r * r / (d.edge_loss * 0.25 * share * share);
  const double flow =
      metering_edge(opening, EdgeSide{1e-12, 0.0, Nothing{}, servodx::fading<AllEffects>(d)}, dp, d).flow;
  return flow / (d.width * h * std::sqrt(dp / d.edge_loss));
}

TEST(EdgeTransition, AbruptFlowMeetsItsTurbulentLimitByTheSquareOfTheLaminarShare) {
  for (const double share : {0.01, 0.03, 0.1}) {
    EXPECT_NEAR((1 - coefficient(0, share)) / share, 0.5, 0.03) << share;
    EXPECT_NEAR((1 - coefficient(1, share)) / (share * share), 0.5, 0.03) << share;
  }
  // Creeping flow is the same of all.
  for (const double a : {1.0, 2.0}) EXPECT_NEAR(coefficient(a, 1e3) / coefficient(0, 1e3), 1.0, 1e-3);
}

// As measured discharge coefficients do (Wu, Burton, Schoenau 2002).
TEST(EdgeTransition, BeyondAbruptTheCoefficientOvershootsItsLimitBySixPerCent) {
  double most = 0, most_at_1 = 0;
  for (double share = 0.01; share < 10; share *= 1.05) {
    most = std::max(most, coefficient(EdgeTransition::parameters[1].upper, share));
    most_at_1 = std::max(most_at_1, coefficient(1, share));
  }
  EXPECT_NEAR(most, 1.06, 0.003);
  EXPECT_LT(most_at_1, 1.0);
}

// The law that simulation tools take; `share` is the laminar over the turbulent drop at the flow's limit.
TEST(EdgeTransition, FadingTheCoefficientSaturatesAsATangentWithinOneAndAHalfPerCent) {
  double worst = 0, worst_kept = 0;
  for (double share = 0.03; share < 30; share *= 1.05) {
    const double limit = std::tanh(1 / share);
    worst = std::max(worst, std::abs(coefficient(1, share, 0.4) - limit));
    worst_kept = std::max(worst_kept, std::abs(coefficient(1, share) - limit));
  }
  EXPECT_LT(worst, 0.015);
  EXPECT_GT(worst_kept, 0.05);
}

// Flow of an edge in oil that thickens over the flow in oil that does not; the edge ends at 100 and 140 bar.
double thickened_flow(double opening, double rise, double dynamic_viscosity) {
  const auto flow = [&](double of_oil) {
    const ParameterVector v = with<PressureViscosity>(0, of_oil);
    const Derived<double> d = derive<double, AllEffects>(v.data(), Oil{.dynamic_viscosity = dynamic_viscosity});
    constexpr double from = 14e6, to = 10e6;
    return metering_edge(opening, from_supply<AllEffects>(d, from), from - to, d).flow;
  };
  return flow(rise) / flow(0);
}

TEST(PressureViscosity, CreepingFlowFallsByBarusLawAtTheMeanPressureAndTurbulentFlowDoesNot) {
  constexpr double rise = 2e-8, mean = 12e6;
  for (const double opening : {-5e-6, 0.0, 5e-6})
    EXPECT_NEAR(thickened_flow(opening, rise, 10.0), std::exp(-rise * mean), 3e-3) << opening;
  EXPECT_NEAR(thickened_flow(3e-4, rise, 1e-3), 1.0, 1e-3);
}

TEST(PressureViscosity, InColdOilTheChambersRestLowerAsTheEdgesFromSupplyPassLess) {
  Scenario s = made(12.0, 1e-3, [](double) { return 0.0; });  // the chambers fill through the leakage at null
  const auto resting = [&](double thicker, double rise) {
    Scenario cold = s;
    cold.oil.dynamic_viscosity *= thicker;
    const Trajectory t = simulate(cold, with<PressureViscosity>(0, rise), all_signals());
    return of(t, Signal::pressure_a).back() + of(t, Signal::pressure_b).back();
  };
  // Creeping flows share the supply as exp(-rise p) of their mean pressures, a quarter and three quarters of it: the
  // middle falls by some rise p / 8 of the supply.
  const ParameterVector v = nominal_candidate();
  const double supply = v[row::supply_pressure], rise = 2e-8, fall = 2 * supply * rise * supply / 8;
  EXPECT_NEAR(resting(10, 0) - resting(10, rise), fall, 0.25 * fall);
}

// Of 1e-4 m3 without air or walls.
double chamber_of(double rise, double pressure) {
  ParameterVector v = with<OilStiffening>(0, rise);
  v[row::air_fraction] = 0;
  return chamber_stiffness<AllEffects>(1e-4, 0.0, pressure, derive<double, AllEffects>(v.data(), Oil{})) * 1e-4;
}

TEST(OilStiffening, TheChambersModulusRisesBySoManyTimesThePressure) {
  const double bulk = chamber_of(0, 1e7), rise = 10;
  EXPECT_NEAR(chamber_of(0, 3e7), bulk, 1e-9 * bulk);
  for (const double pressure : {0.0, 1e7, 2e7, 4.5e7})
    EXPECT_NEAR(chamber_of(rise, pressure), bulk + rise * pressure, 1e-9 * bulk) << pressure;
}

TEST(OilStiffening, AChamberUnderPressureAnswersLess) {
  // A blow on a shut piston: the rod is pushed, both ports covered. The stiffer oil lets it move less.
  Scenario s = made(0.2, 1e-3, [](double) { return 0.0; });
  s.load_force.resize(s.time.size());
  const double area = nominal_candidate()[row::piston_area_a];
  for (std::size_t k = 0; k < s.time.size(); ++k) s.load_force[k] = s.time[k] > 0.1 ? 2e6 * area : 0.0;
  const auto moved = [&](double rise) {
    const Trajectory t = simulate(s, with<OilStiffening>(0, rise), all_signals());
    const std::vector<double>& x = of(t, Signal::piston_position);
    const auto [low, high] = std::minmax_element(x.begin() + 100, x.end());
    return *high - *low;
  };
  EXPECT_LT(moved(20), 0.95 * moved(0));
}

TEST(ReturnDrop, RaisesTheChambersByHalfOfItsShareUnlessTheReturnIsMeasured) {
  // At a steady speed with no load: supply - p_A = p_B - return - drop, with an edge's drop each and no hose.
  Scenario s = made(0.6, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 18e-3; });
  ParameterVector v = nominal_candidate();
  v[row::hose_resistance] = 0;
  const double share = 0.4;
  ParameterVector w = v;
  w[effect_row<ReturnDrop>(0)] = share;
  const Trajectory free = simulate(s, v, all_signals()), dammed = simulate(s, w, all_signals());
  const auto sum = [](const Trajectory& t) { return of(t, Signal::pressure_a)[500] + of(t, Signal::pressure_b)[500]; };
  const double stroke = of(dammed, Signal::spool_position)[500] / v[row::spool_stop];
  const double both = v[row::supply_pressure] - v[row::return_pressure];
  const double edges = both / (2 + share * stroke * stroke);  // the drop of one edge
  EXPECT_NEAR(sum(dammed) - sum(free), share * stroke * stroke * edges, 0.05 * share * edges);
  s.return_pressure.assign(s.time.size(), v[row::return_pressure]);
  EXPECT_NEAR(of(simulate(s, w, all_signals()), Signal::pressure_a)[500],
              of(simulate(s, v, all_signals()), Signal::pressure_a)[500], 1.0);  // [Pa]
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

TEST(MainsPickup, OnTheCommandItIsASineOfCurrentThatTheValveFollows) {
  Scenario s = stepped(), humming = s;
  const double size = 0.01;  // of rated current
  for (std::size_t k = 0; k < s.time.size(); ++k)
    humming.command[k] += size * s.rated_current * std::cos(2 * std::numbers::pi * 50.0 * s.time[k]);
  const auto expected = of(simulate(humming, nominal_candidate(), all_signals()), Signal::spool_position);
  const auto found =
      of(simulate(s, with<MainsPickup>(2 * MainsPickup::current, size), all_signals()), Signal::spool_position);
  const auto still = of(simulate(s, nominal_candidate(), all_signals()), Signal::spool_position);
  double largest = 0;
  for (std::size_t k = 60; k < s.time.size(); ++k) {
    EXPECT_NEAR(found[k], expected[k], 1e-8) << k;
    largest = std::max(largest, std::abs(found[k] - still[k]));
  }
  EXPECT_GT(largest, 1e-6);
}

TEST(SensorResponse, LagOfARampIsItsSlopeTimesTheTimeConstant) {
  Scenario s = made(0.6, 1e-3, [](double t) { return t < 0.05 ? 0.0 : 10e-3 * (t - 0.05); });
  const Trajectory clean = simulate(s, nominal_candidate(), all_signals());
  const Trajectory lagged = simulate(s, with<SensorResponse>(1, 5e-3), all_signals());
  const auto &a = of(clean, Signal::spool_position), &b = of(lagged, Signal::spool_position);
  const double slope = (a[500] - a[400]) / 0.1;
  EXPECT_NEAR(a[500] - b[500], 5e-3 * slope, 0.05 * 5e-3 * slope);
}

TEST(SensorResponse, RunBeginsAtWhatTheSensorShows) {
  Scenario s = stepped();
  s.pressure_a_start = 100e5, s.pressure_b_start = 90e5, s.spool_start = 3e-6;
  for (const auto& [number, signal, shown] :
       {std::tuple{0, Signal::spool_position, 3e-6}, {2, Signal::pressure_a, 100e5}, {4, Signal::pressure_b, 90e5}}) {
    const Trajectory t = simulate(s, with<SensorResponse>(number, 1.1), all_signals());
    EXPECT_NEAR(of(t, signal).front(), shown, 1e-3 * shown);
  }
}

TEST(SampledLag, SineComesOutSmallerAndLaterAsOfAFirstOrderLag) {
  constexpr double period = 1e-3;
  for (const double frequency : {5.0, 20.0, 50.0})
    for (const double lag : {0.1e-3, 1e-3, 8e-3}) {
      const double w = 2 * std::numbers::pi * frequency;
      SampledLag<double> lagged;
      double worst = 0;
      for (int k = 0; k < 1000; ++k) {
        const double t = period * k, y = lagged(t, std::sin(w * t), lag, w);
        if (k > 500)
          worst =
              std::max(worst, std::abs(y - (std::sin(w * t) - w * lag * std::cos(w * t)) / (1 + w * w * lag * lag)));
      }
      std::printf("%2.0f Hz, lag %.1f ms: off by %.5f\n", frequency, 1e3 * lag, worst);
      EXPECT_LT(worst, 0.02);
    }
}

TEST(PositionSensor, LagOfManySamplesDampsAFastMotion) {
  // 30 Hz behind 8 ms: 0.55 of the motion; its speed times the lag would be 1.5 of it.
  Scenario s = stepped();
  for (std::size_t k = 0; k < s.time.size(); ++k) s.command[k] = 6e-3 * std::sin(2 * std::numbers::pi * 30 * s.time[k]);
  ParameterVector late = nominal_candidate();
  late[row::position_sensor_lag] = 8e-3;
  const auto swing = [&](const ParameterVector& v) {
    const auto x = of(simulate(s, v, all_signals()), Signal::piston_position);
    double sum = 0, mean = 0;
    for (std::size_t k = 200; k < 400; ++k) mean += x[k] / 200;
    for (std::size_t k = 200; k < 400; ++k) sum += (x[k] - mean) * (x[k] - mean);
    return std::sqrt(sum);
  };
  const double ratio = swing(late) / swing(nominal_candidate()), w = 2 * std::numbers::pi * 30 * 8e-3;
  EXPECT_NEAR(ratio, 1 / std::sqrt(1 + w * w), 0.05);
}

// Spool over rated stroke along a slow triangle of `amplitude` (of rated), the last of three cycles.
struct Loop {
  double width, gain;  // [of rated current]: at the middle, between the branches; peak to peak over the command's
};
Loop slow_loop(ParameterVector v, double amplitude) {
  constexpr double period = 0.8;
  v[row::spool_friction] = 0.05;  // what is left is the iron's
  v[row::driver_bandwidth] = 3000;
  const Scenario s = made(3 * period, 1e-3, [&](double t) {
    const double phase = t / period - std::floor(t / period);
    const double x = phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4;
    return 20e-3 * amplitude * x;
  });
  const Trajectory t = simulate(s, v, all_signals());
  EXPECT_TRUE(t.ok);
  const auto& x = of(t, Signal::spool_position);
  const auto at = [&](double phase) { return x[static_cast<std::size_t>(std::lround((2 + phase) * period / 1e-3))]; };
  const double travel = at(0.25) - at(0.75), per_rated = travel / (2 * amplitude);
  return {std::abs(at(0.5) - at(1.0 - 1e-9)) / per_rated, per_rated};
}

TEST(MagneticHysteresis, LargeCycleHasTheWholeLoopAndASmallOneLessGain) {
  const Loop without = slow_loop(nominal_candidate(), 1.0), without_small = slow_loop(nominal_candidate(), 0.05);
  const ParameterVector v = with<MagneticHysteresis>(0, 0.03);
  const Loop large = slow_loop(v, 1.0), small = slow_loop(v, 0.05);
  // The spool lags a triangle in any case: that much is taken off.
  EXPECT_NEAR(large.width - without.width, 0.03, 0.003);
  EXPECT_LT(small.width - without_small.width, 0.4 * 0.03);
  EXPECT_GT(small.width - without_small.width, 0.02 * 0.03);
  EXPECT_LT(small.gain / without_small.gain, large.gain / without.gain - 0.02);
}

TEST(MagneticHysteresis, LoopOfALargeCycleIsAsWideAsStatedHoweverSoonItOpens) {
  const Loop without = slow_loop(nominal_candidate(), 1.0);
  for (const double width : {0.03, 0.06, 0.12})
    for (const double reach : {0.05, 0.5}) {
      ParameterVector v = with<MagneticHysteresis>(0, width);
      v[effect_row<MagneticHysteresis>(1)] = reach;
      const double found = slow_loop(v, 1.0).width - without.width;
      std::printf("width %.2f, reach %.2f: %.4f\n", width, reach, found);
      EXPECT_NEAR(found, width, 0.1 * width);
    }
}

TEST(MagneticHysteresis, SlewingFlapperLeavesTheIronFurtherOnThanTheCurrentAloneWould) {
  // After a step the flux has been beyond where it rests: part of the loop is undone, and the spool stops nearer to the
  // line without hysteresis.
  const Scenario s = made(0.4, 1e-3, [](double t) { return t < 0.1 ? 0.0 : 8e-3; });
  const auto end = [&](const ParameterVector& v) {
    return of(simulate(s, v, all_signals()), Signal::spool_position).back();
  };
  ParameterVector still = with<MagneticHysteresis>(0, 0.03), moved = still;
  still[effect_row<MagneticHysteresis>(3)] = 0.0;
  moved[effect_row<MagneticHysteresis>(3)] = 1.5;
  const double line = end(nominal_candidate());
  EXPECT_LT(end(still), line);
  EXPECT_GT(end(moved), end(still));
}

TEST(ArmatureAngle, FlapperOnItsNozzleStaysThereLonger) {
  const Scenario s = made(0.3, 1e-3, [](double t) { return t < 0.1 ? -15e-3 : 15e-3; });
  const auto slew = [&](double travel) {
    return of(simulate(s, with<ArmatureAngle>(0, travel), all_signals()), Signal::spool_position);
  };
  const auto flat = slew(0.0), curved = slew(0.08);
  double most = 0;
  for (std::size_t k = 100; k < 140; ++k) most = std::max(most, curved[k] - flat[k]);
  EXPECT_GT(most, 5e-6);
  EXPECT_NEAR(curved.back(), flat.back(), 2e-6);  // at rest the flapper is near its middle
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
