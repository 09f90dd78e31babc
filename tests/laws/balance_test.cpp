// What the equations must keep whatever the numbers: oil, symmetry, dissipation.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/random.h"
#include "base/smooth.h"
#include "effects/mains_pickup.h"
#include "effects/nozzle_mismatch.h"
#include "effects/port_line.h"
#include "effects/registry.h"
#include "effects/rod_cavity.h"
#include "effects/supply_droop.h"
#include "laws/bench.h"
#include "model/asperities.h"
#include "model/chamber.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

template <class Effects>
void stored_rates_balance(const ParameterVector& v) {
  const Bench<Effects> bench(v);
  const Derived<double>& d = bench.derived();
  const double* p = bench.p();
  for (unsigned trial = 0; trial < 200; ++trial) {
    Random random(11, trial);
    auto y = bench.state(random);
    if constexpr (Effects::n_states > 0)  // the flows below are taken at the source's pressure
      y[n_base_states + Effects::template state_offset<SupplyDroop>()] = 0;
    const auto u = bench.inputs(random);
    const auto f = bench.rate(y, u);
    // Chambers: what the edges let in either is stored or makes room for the piston; the leak across it cancels.
    const double v_rel = f[s_x_piston];
    const double volume_a = p[row::dead_volume_a] + p[row::piston_area_a] * (p[row::piston_stroke] / 2 + y[s_x_piston]);
    const double volume_b = p[row::dead_volume_b] + p[row::piston_area_b] * (p[row::piston_stroke] / 2 - y[s_x_piston]);
    const double stored_a = f[s_p_a] / chamber_stiffness<Effects>(volume_a, p[row::hose_compliance], y[s_p_a], d) +
                            p[row::piston_area_a] * v_rel;
    const double stored_b = f[s_p_b] / chamber_stiffness<Effects>(volume_b, p[row::hose_compliance], y[s_p_b], d) -
                            p[row::piston_area_b] * v_rel;
    const auto edge = [&](double opening, const auto& side, double dp) {
      return metering_edge(opening, side, dp, d).flow;
    };
    const auto from = from_supply<Effects>(d, u.supply_pressure);
    const auto to = to_return<Effects>(d, u.return_pressure);
    double lines = 0;  // what goes into the volumes behind the ports
    if constexpr (Effects::n_states > 0)
      for (int s : {0, 1}) lines += f[n_base_states + Effects::template state_offset<PortLine>() + s];
    const double in = edge(y[s_x_spool] - p[row::lap_pa], from, u.supply_pressure - y[s_p_a]) +
                      edge(-y[s_x_spool] - p[row::lap_pb], from, u.supply_pressure - y[s_p_b]);
    const double out = edge(-y[s_x_spool] - p[row::lap_at], to, y[s_p_a] - u.return_pressure) +
                       edge(y[s_x_spool] - p[row::lap_bt], to, y[s_p_b] - u.return_pressure);
    double stored_rod = 0;  // in the rod cavity, which takes its area's room from chamber A
    if constexpr (Effects::n_states > 0) {
      const double length = p[effect_row<RodCavity>(1)] + p[row::piston_stroke] / 2 + y[s_x_piston];
      stored_rod =
          soft_positive(length, RodCavity::shortest) * f[n_base_states + Effects::template state_offset<RodCavity>()];
    }
    EXPECT_NEAR(stored_a + stored_b + stored_rod + lines, in - out,
                1e-9 * (std::abs(in) + std::abs(out) + std::abs(stored_a)))
        << trial;

    // Pilot stage: what the spool pushes out of one end it takes in at the other. So the rate at which the three nodes
    // store oil does not depend on the spool's speed, and grows by no more than what passes the filter.
    const auto stored_pilot = [&](const auto& rate) {
      return rate[s_p_filter] / d.inverse_filter_compliance +
             (rate[s_p_pilot_1] + rate[s_p_pilot_2]) / d.inverse_pilot_compliance;
    };
    auto faster = y;
    faster[s_v_spool] += 0.1;
    const double moved = 0.1 * d.spool_area;
    EXPECT_NEAR(stored_pilot(bench.rate(faster, u)), stored_pilot(f), 1e-6 * moved) << trial;
    auto closed = u;  // no drop over the filter: the nodes only lose, through the nozzles
    closed.supply_pressure = y[s_p_filter];
    EXPECT_LT(stored_pilot(bench.rate(y, closed)), 0.0) << trial;
  }
}

TEST(Balance, StoredOilEqualsFlowInMinusFlowOut) {
  stored_rates_balance<NoEffects>(nominal_candidate());
  stored_rates_balance<AllEffects>(with_effects(nominal_candidate()));
}

TEST(Balance, OilStoredOverARunEqualsTheFlowsOfTheRun) {
  ParameterVector v = nominal_candidate();
  v[row::position_sensor_lag] = 0;  // the reported position is the piston's
  v[row::cross_piston_leakage] = 1e-12;
  v[row::air_fraction] = 0.01;
  const Scenario s = made(
      0.6, 5e-5, [](double t) { return 0.012 * std::sin(2 * std::numbers::pi * 5 * t); },
      [](double t) { return 3000 * std::sin(2 * std::numbers::pi * 3 * t); });
  SimulateOptions o = all_signals();
  o.step = 5e-5;
  const Trajectory t = simulate(s, v, o);
  ASSERT_TRUE(t.ok);
  const Derived<double> d = derive<double>(v.data(), s.oil);
  const auto& a = of(t, Signal::pressure_a);
  const auto& b = of(t, Signal::pressure_b);
  const auto& x = of(t, Signal::piston_position);
  double stored_a = 0, stored_b = 0, in_a = 0, in_b = 0, passed = 0;
  for (std::size_t k = 1; k < s.time.size(); ++k) {
    const auto mean = [&](Signal c) { return 0.5 * (of(t, c)[k] + of(t, c)[k - 1]); };
    const double dt = s.time[k] - s.time[k - 1], travel = 0.5 * (x[k] + x[k - 1]);
    const double volume_a = v[row::dead_volume_a] + v[row::piston_area_a] * (v[row::piston_stroke] / 2 + travel);
    const double volume_b = v[row::dead_volume_b] + v[row::piston_area_b] * (v[row::piston_stroke] / 2 - travel);
    stored_a += (a[k] - a[k - 1]) /
                    chamber_stiffness<NoEffects>(volume_a, v[row::hose_compliance], mean(Signal::pressure_a), d) +
                v[row::piston_area_a] * (x[k] - x[k - 1]);
    stored_b += (b[k] - b[k - 1]) /
                    chamber_stiffness<NoEffects>(volume_b, v[row::hose_compliance], mean(Signal::pressure_b), d) -
                v[row::piston_area_b] * (x[k] - x[k - 1]);
    const double leak = d.leak * (mean(Signal::pressure_a) - mean(Signal::pressure_b));
    in_a += dt * (mean(Signal::flow_a) - leak);
    in_b += dt * (mean(Signal::flow_b) + leak);
    passed += dt * std::abs(mean(Signal::flow_a));
  }
  std::printf("oil of the run: A stored %.6g of %.6g m3, B %.6g of %.6g, passed %.6g\n", stored_a, in_a, stored_b, in_b,
              passed);
  EXPECT_GT(passed, 1e-6);
  // Trapezoids of 50 us.
  EXPECT_NEAR(stored_a, in_a, 1e-4 * passed);
  EXPECT_NEAR(stored_b, in_b, 1e-4 * passed);
}

TEST(Balance, MirroredCurrentMirrorsMotion) {
  for (const bool effects : {false, true}) {
    ParameterVector v = nominal_candidate();
    if (effects) {
      v = with_effects(v);
      for (int j = 0; j < 2 * MainsPickup::channels; ++j)
        v[effect_row<MainsPickup>(j)] = 0;  // the mains mirror nothing
      v[effect_row<RodCavity>(0)] = 0;      // on one side only
    }
    v[row::lap_pa] = v[row::lap_pb] = 3e-6;
    v[row::lap_at] = v[row::lap_bt] = -2e-6;
    v[row::piston_area_b] = v[row::piston_area_a];
    v[row::dead_volume_b] = v[row::dead_volume_a];
    v[row::filter_blockage_positive] = 0.7, v[row::filter_blockage_negative] = 0.4;
    v[row::servovalve_null] = 0.02;
    ParameterVector mirror = v;
    mirror[row::filter_blockage_positive] = 0.4, mirror[row::filter_blockage_negative] = 0.7;
    mirror[row::servovalve_null] = -0.02;
    mirror[effect_row<NozzleMismatch>(0)] *= -1;
    const auto command = [](double t) { return t < 0.01 ? 0.0 : t < 0.2 ? 0.015 : -0.02 * std::sin(40 * t); };
    const auto load = [](double t) { return 4000 * std::sin(25 * t) + 500; };
    const Scenario s = made(0.5, 1e-3, command, load);
    const Scenario m = made(
        0.5, 1e-3, [&](double t) { return -command(t); }, [&](double t) { return -load(t); });
    const Trajectory a = simulate(s, v, all_signals()), b = simulate(m, mirror, all_signals());
    ASSERT_TRUE(a.ok && b.ok);
    const auto mirrors = [&](Signal of_a, Signal of_b, double sign) {
      double largest = 0, worst = 0;
      for (std::size_t k = 0; k < s.time.size(); ++k) {
        largest = std::max(largest, std::abs(of(a, of_a)[k]));
        worst = std::max(worst, std::abs(of(a, of_a)[k] - sign * of(b, of_b)[k]));
      }
      // Sums of a and b are taken in another order: rounding, grown along the run.
      EXPECT_LT(worst, 1e-7 * largest) << info(of_a).name;
    };
    mirrors(Signal::spool_position, Signal::spool_position, -1);
    mirrors(Signal::piston_position, Signal::piston_position, -1);
    mirrors(Signal::pressure_a, Signal::pressure_b, 1);
    mirrors(Signal::pilot_pressure_1, Signal::pilot_pressure_2, 1);
    mirrors(Signal::flow_a, Signal::flow_b, 1);
  }
}

// Inputs with the asperities dragged behind the motion.
template <class Effects>
Inputs<double> dragged(const Bench<Effects>& bench, const typename Bench<Effects>::Y& y, Inputs<double> u) {
  const double rod = bench.rate(y, u)[s_x_piston];  // relative to the body
  const double h = 1.0;                             // far enough for all to slip
  u.friction.rest(y[s_x_spool] - y[s_v_spool] * h, y[s_x_piston] - rod * h);
  u.friction.move(y[s_x_spool] - y[s_v_spool] * h, y[s_x_spool], y[s_x_piston] - rod * h, y[s_x_piston], h,
                  bench.derived().spool_presliding, bench.derived().breakaway);
  return u;
}

// Each sort of friction takes power from what slides, at any speed.
template <class Effects>
void friction_takes_power(ParameterVector v, int row, int at, int position) {
  const Bench<Effects> with(v);
  v[row] = 0;
  const Bench<Effects> without(v);
  for (unsigned trial = 0; trial < 500; ++trial) {
    Random random(13, trial);
    auto y = with.state(random);
    const auto u = with.inputs(random);
    for (const double scale : {1.0, 1e-2, 1e-4}) {  // through the Stribeck range
      y[s_v_spool] *= scale;
      y[s_v_piston] *= scale;
      const auto now = dragged(with, y, u);
      const double slip = with.rate(y, now)[position];
      EXPECT_LT((with.rate(y, now)[at] - without.rate(y, now)[at]) * slip, 0.0)
          << parameter_list[row].name << ' ' << trial << ' ' << scale;
    }
  }
}

TEST(Balance, FrictionTakesPowerFromWhatSlides) {
  ParameterVector v = nominal_candidate();
  v[row::piston_stribeck_friction] = 800;
  for (const ParameterVector& w : {v, with_effects(v)}) {
    friction_takes_power<AllEffects>(w, row::spool_friction, s_v_spool, s_x_spool);
    for (int row : {row::piston_viscous_friction, row::piston_coulomb_friction, row::piston_stribeck_friction})
      friction_takes_power<AllEffects>(w, row, s_v_piston, s_x_piston);
  }
}

TEST(Balance, SealsThatHoldMoreHoldLongerAndAreNoStiffer) {
  // What holds the rod against a slow push, from rest.
  const auto held = [](double breakaway, double push) {
    ParameterVector v = nominal_candidate();
    v[row::piston_stribeck_friction] = breakaway;
    const Bench<AllEffects> bench(v);
    Random random(21, 1);
    auto y = bench.state(random);
    y[s_v_piston] = 0;
    auto u = bench.inputs(random);
    u.friction.rest(y[s_x_spool], y[s_x_piston] - push);
    const double h = push / 1e-5;  // [s] at 10 um/s
    u.friction.move(y[s_x_spool], y[s_x_spool], y[s_x_piston] - push, y[s_x_piston], h,
                    bench.derived().spool_presliding, bench.derived().breakaway);
    auto free = u;
    free.friction.rest(y[s_x_spool], y[s_x_piston]);
    return v[row::moving_mass] * (bench.rate(y, free)[s_v_piston] - bench.rate(y, u)[s_v_piston]);
  };
  const double sliding = nominal_candidate()[row::piston_coulomb_friction];
  // Before they slip: force over reach, of which a tenth of the breakaway friction counts as sliding.
  const double reach = 1 + 500 / (sliding + 50 + constants::least_friction);
  EXPECT_NEAR(held(500, 1e-6) / held(0, 1e-6), (sliding + 500) / sliding / reach, 0.01);
  EXPECT_NEAR(held(0, 1e-2), sliding, 1e-3 * sliding);
  EXPECT_NEAR(held(500, 1e-2), sliding + 500, 1e-3 * (sliding + 500));
}

// A step runs ahead of the anchor by as much as the part slides in it.
TEST(Balance, SlidingFrictionIsTheSameHoweverFarAStepRunsAheadOfItsAnchor) {
  for (const double stretch : {1.0, 1.3, 2.0, 30.0}) {
    EXPECT_EQ(asperities<double>(stretch), 1.0) << stretch;
    EXPECT_EQ(asperities<double>(-stretch), -1.0) << stretch;
  }
}

TEST(Balance, AsperitiesReturnNoMoreThanTheyStoreAndSpendOnEveryCycle) {
  constexpr double presliding = 2e-6;
  for (unsigned trial = 0; trial < 100; ++trial) {
    Random random(19, trial);
    // There and back again between random ends, some within presliding; work in friction times presliding lengths.
    double x = 0, anchor = 0, work = 0, least = 0;
    for (int leg = 0; leg < 20; ++leg) {
      const double end = leg == 19 ? 0.0 : random.uniform(-5.0, 5.0) * presliding * (leg % 3 ? 1.0 : 0.1);
      const double step = (end - x) / 1000;
      for (int k = 0; k < 1000; ++k) {
        x += step;
        work += asperities<double>((x - 0.5 * step - anchor) / presliding) * step / presliding;
        anchor = dragged_anchor(anchor, x, presliding);
        least = std::min(least, work);
      }
    }
    EXPECT_GT(least, -1e-3) << trial;  // starts unstretched: never more back than went in
    EXPECT_GT(work, 0.5) << trial;     // many lengths slid
  }
}

TEST(Balance, SettledStateStandsStill) {
  // Equal areas and no load: with constant inputs at rest everything is in balance, whatever the null.
  for (const double null : {0.0, 0.01}) {
    ParameterVector v = nominal_candidate();
    v[row::servovalve_null] = null;
    const auto command = [&](double) { return -null * 0.02; };
    const Scenario s = made(1.0, 1e-3, command);
    const Trajectory first = simulate(s, v, all_signals());
    ASSERT_TRUE(first.ok);
    // And again from what a log of that rest would have measured.
    Scenario again = s;
    again.spool_start = of(first, Signal::spool_position).back();
    again.pressure_a_start = of(first, Signal::pressure_a).back();
    again.pressure_b_start = of(first, Signal::pressure_b).back();
    again.piston_start = of(first, Signal::piston_position).back();
    for (const Trajectory& t : {first, simulate(again, v, all_signals())})
      for (int c = 0; c < n_simulated; ++c) {
        const auto [low, high] = std::minmax_element(t.signals[c].begin(), t.signals[c].end());
        // Below any sensor: 0.01 um of spool, 1 um of piston, 0.01 bar, 0.001 l/min.
        const Signal signal = simulated_signals[c];
        const double limit = signal == Signal::spool_position    ? 1e-8
                             : signal == Signal::piston_position ? 1e-6
                             : c < 6                             ? 1e3
                                                                 : 0.001 / 60e3;
        EXPECT_LT(*high - *low, limit) << info(signal).name << " null " << null;
      }
  }
}

TEST(Balance, SpoolStandsStillUnderAConstantCommandFromItsMeasuredPosition) {
  const ParameterVector v = nominal_candidate();
  const Scenario s = made(0.3, 1e-3, [](double) { return 0.004; });
  const Trajectory first = simulate(s, v, all_signals());
  ASSERT_TRUE(first.ok);
  Scenario again = s;
  again.spool_start = of(first, Signal::spool_position).back();
  again.pressure_a_start = of(first, Signal::pressure_a).back();
  again.pressure_b_start = of(first, Signal::pressure_b).back();
  again.piston_velocity_start =
      (of(first, Signal::piston_position).back() - *(of(first, Signal::piston_position).end() - 2)) / 1e-3;
  const Trajectory t = simulate(again, v, all_signals());
  ASSERT_TRUE(t.ok);
  const auto& x = of(t, Signal::spool_position);
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  EXPECT_GT(*low, 0.1 * v[row::spool_stop]);
  EXPECT_LT(*high - *low, 1e-6);
}

}  // namespace
}  // namespace servodx
