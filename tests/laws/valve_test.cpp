// What a servovalve does, healthy and not; on the nominal table.
#include <gtest/gtest.h>

#include <cmath>

#include "base/random.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "laws/bench.h"
#include "model/constants.h"
#include "model/derivative.h"
#include "model/derived.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

namespace servodx {
namespace {

double at_rest(const ParameterVector& v, Signal s) {
  const Trajectory t = simulate(made(0.2, 1e-3, [](double) { return 0.0; }), v, all_signals());
  EXPECT_TRUE(t.ok);
  return of(t, s).back();
}

TEST(Valve, PilotPressureBetweenHalfAndTwoThirdsOfSupply) {
  const ParameterVector tables[] = {candidate_of(read_table(shipped("params/borello2009.csv"))), nominal_candidate()};
  for (const ParameterVector& v : tables) {
    const double supply = v[row::supply_pressure] - v[row::return_pressure];
    for (Signal s : {Signal::pilot_pressure_1, Signal::pilot_pressure_2}) {
      const double ratio = (at_rest(v, s) - v[row::return_pressure]) / supply;
      std::printf("%s over supply, both above return: %.3f\n", std::string(info(s).name).c_str(), ratio);
      EXPECT_GT(ratio, 0.5);
      EXPECT_LT(ratio, 2.0 / 3.0);
    }
  }
}

TEST(Valve, PilotPressureFallsWhenTheFilterClogs) {
  double last = 1e300;
  for (double blocked : {0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95, 0.98}) {
    ParameterVector v = nominal_candidate();
    find_fault("clogged_filter")->apply(v.data(), blocked);
    const double pressure = at_rest(v, Signal::pilot_pressure_1);
    EXPECT_LT(pressure, last) << blocked;
    last = pressure;
  }
  // At the last one the screen passes a tenth of the orifices' conductance: most of the pressure is lost.
  EXPECT_LT(last, 0.2 * at_rest(nominal_candidate(), Signal::pilot_pressure_1));
}

TEST(Valve, FilterBlockedInOneDirectionSlowsTheSpoolInThatDirection) {
  const auto slew = [](const ParameterVector& v, double sign) {
    const Trajectory t =
        simulate(made(0.05, 2.5e-4, [&](double s) { return s < 0.005 ? 0.0 : sign * 0.02; }), v, all_signals());
    double fastest = 0;
    const auto& x = of(t, Signal::spool_position);
    for (std::size_t k = 1; k < x.size(); ++k) fastest = std::max(fastest, sign * (x[k] - x[k - 1]));
    return fastest;
  };
  ParameterVector v = nominal_candidate();
  const double healthy = slew(v, 1);
  v[row::filter_blockage_positive] = 0.9;
  EXPECT_LT(slew(v, 1), 0.8 * healthy);
  EXPECT_GT(slew(v, -1), 0.95 * healthy);
}

TEST(Valve, FeedbackLostDrivesSpoolToItsStopAndRaisesPilotPressureDifference) {
  const ParameterVector healthy = nominal_candidate();
  ParameterVector lost = healthy;
  find_fault("feedback_wire_lost")->apply(lost.data(), 0.0);
  for (double sign : {1.0, -1.0}) {
    const Scenario s = made(0.4, 1e-3, [&](double t) { return t < 0.01 ? 0.0 : sign * 0.004; });
    const Trajectory with = simulate(s, healthy, all_signals()), without = simulate(s, lost, all_signals());
    ASSERT_TRUE(with.ok && without.ok);
    const auto end = [&](const Trajectory& t, Signal c) { return sign * of(t, c).back(); };
    const auto dp = [&](const Trajectory& t) {
      return end(t, Signal::pilot_pressure_1) - end(t, Signal::pilot_pressure_2);
    };
    EXPECT_LT(end(with, Signal::spool_position), 0.3 * healthy[row::spool_stop]);
    EXPECT_GT(end(without, Signal::spool_position), 0.98 * healthy[row::spool_stop]);
    EXPECT_LT(end(without, Signal::spool_position), 1.1 * healthy[row::spool_stop]) << "the stop must hold";
    EXPECT_GT(dp(without), 3 * std::abs(dp(with)));
  }
}

TEST(Valve, SpoolFollowsTheCurrentByTorqueGainOverWireStiffness) {
  const ParameterVector v = nominal_candidate();
  const double current = 0.25 * 0.02;
  const Trajectory t = simulate(made(0.3, 1e-3, [&](double) { return current; }), v, all_signals());
  const double wire_only = v[row::torque_motor_gain] * current / v[row::feedback_wire_stiffness];
  // Flow forces and the flapper's spring take some per cent.
  EXPECT_NEAR(of(t, Signal::spool_position).back(), wire_only, 0.08 * wire_only);
}

// First stages of industrial valves: a light flapper with the spool held sings where it is far from its rest, and the
// first command may be. The run begins at the rest all the same: nothing in the first stage drives the held spool.
TEST(Valve, ARunBeginsWithItsFirstStageAtRestWhateverTheFirstCommandIs) {
  Random random(1);
  const auto about = [&](double nominal, double times) {
    return nominal * std::exp(random.uniform(-1, 1) * std::log(times));
  };
  for (int trial = 0; trial < 20; ++trial) {
    ParameterVector v = nominal_candidate();
    v[row::torque_motor_frequency] = about(480, 1.6), v[row::flapper_stiffness] = about(5900, 1.5);
    v[row::hydraulic_amplifier_gain] = about(1.4e-3, 1.2), v[row::nozzle_gap] = about(40e-6, 1.2);
    v[row::fixed_orifice_diameter] = about(2.6e-4, 1.2), v[row::spool_diameter] = 9.2e-3;
    Scenario jumped = made(0.01, 1e-3, [](double) { return 0.02; });
    jumped.spool_start = 0.0;
    const Trajectory t = simulate(jumped, v, all_signals());
    ASSERT_TRUE(t.ok) << trial;
    const double between = of(t, Signal::pilot_pressure_1).front() - of(t, Signal::pilot_pressure_2).front();
    EXPECT_LT(std::abs(between), 0.01 * v[row::supply_pressure]) << trial;
  }
}

TEST(Valve, StopsDoNotActBeforeContact) {
  // A stiff stop with a tail would hold the spool back at full stroke.
  ParameterVector near = nominal_candidate(), far = near;
  const Scenario s = made(0.15, 1e-3, [](double t) { return t < 0.02 ? 0.0 : 18e-3; });
  const double reached = of(simulate(s, near, all_signals()), Signal::spool_position).back();
  near[row::spool_stop] = reached + 2e-5;
  far[row::spool_stop] = 2 * reached;
  EXPECT_NEAR(of(simulate(s, near, all_signals()), Signal::spool_position).back(),
              of(simulate(s, far, all_signals()), Signal::spool_position).back(), 5e-8);
}

// A rod at some 0.3 m/s begins one step in thirty within the roughness of its stop's face, where the force grows
// several times as steeply as inside. That must not throw it back, whatever its values.
TEST(Valve, StopHoldsTheRodThatComesUponIt) {
  const Table table = shipped_table();
  const double stop = table[row::piston_stroke].nominal / 2;
  int met = 0;
  for (double current : {12e-3, 18e-3}) {
    Scenario s = made(0.5, 1e-3, [&](double t) { return current * std::min(1.0, t / 0.1); });
    s.piston_start = 0.75 * stop;
    std::vector<ParameterVector> v(512, nominal_candidate());
    std::vector<Trajectory> t(v.size());
    std::vector<Job> jobs;
    for (std::uint32_t i = 0; i < v.size(); ++i) {
      Random random(3, i);
      for (int r = 0; r < n_parameters; ++r)
        if (table[r].estimate) v[i][r] = coordinate(table[r]).from_unit(random.uniform());
      jobs.push_back({&s, &v[i], &t[i]});
    }
    simulate(jobs, {});
    for (std::size_t i = 0; i < v.size(); ++i) {
      ASSERT_TRUE(t[i].ok);
      double furthest = 0, back = 0;
      for (double x : of(t[i], Signal::piston_position)) {
        furthest = std::max(furthest, x);
        if (furthest > 0.97 * stop) back = std::max(back, furthest - x);
      }
      met += furthest > 0.999 * stop;
      EXPECT_LT(back, 1e-4) << "candidate " << i << " at " << current << " A";
    }
  }
  EXPECT_GT(met, 200);
}

TEST(Valve, NozzlePassesItsCurtainWhenNarrowAndItsBoreWhenWide) {
  const ParameterVector v = nominal_candidate();
  const Derived<double> d = derive<double>(v.data(), Oil{});
  const double dp = 1e7, curtain = d.nozzle_conductance * std::sqrt(dp);
  EXPECT_NEAR(nozzle_flow(1e-7, dp, d) / (curtain * 1e-7), 1.0, 1e-4);
  // Far from the flapper one velocity head of the bore takes the whole drop.
  const double bore = d.nozzle_area * std::sqrt(2 * dp / (constants::nozzle_bore_loss * Oil{}.density));
  EXPECT_NEAR(nozzle_flow(0.1, dp, d) / bore, 1.0, 1e-3);
}

// 2 Cd w times J is the flux of momentum rho q^2 / (Cc w h), with Cc = Cd where the jet loses no speed (Merritt 1967,
// sec. 5-6).
TEST(Valve, AJetPushesByItsMomentumSoThatACreepingOneHardlyDoes) {
  const ParameterVector v = nominal_candidate();
  const Oil oil{};
  const Derived<double> d = derive<double>(v.data(), oil);
  constexpr double opening = 1e-4, cd = constants::cd_metering;
  const double height = std::sqrt(opening * opening + 0.25 * d.clearance2), width = v[row::port_width];
  const auto jet_of = [&](double dp) {
    const auto [flow, jet] = metering_edge(opening, EdgeSide{1e-12, 0.0}, dp, d);
    const double j = oil.density / (cd * cd) * jet;  // [N/m] that the model's force grows with
    EXPECT_NEAR(2 * cd * width * j / (oil.density * flow * flow / (cd * width * height)), dp > 0 ? 1 : -1, 1e-9);
    return j / (height * dp);
  };
  EXPECT_NEAR(jet_of(2e7), 1.0, 0.05);
  EXPECT_NEAR(jet_of(-2e7), 1.0, 0.05);
  EXPECT_LT(jet_of(10.0), 0.05);
}

TEST(Valve, FlowRisesWithPortWidth) {
  ParameterVector v = nominal_candidate();
  const Scenario s = made(0.2, 1e-3, [](double t) { return t < 0.01 ? 0.0 : 0.01; });
  const auto travel = [&] { return of(simulate(s, v, all_signals()), Signal::piston_position).back(); };
  const double before = travel();
  v[row::port_width] *= 1.2;
  EXPECT_GT(travel(), 1.15 * before);
}

}  // namespace
}  // namespace servodx
