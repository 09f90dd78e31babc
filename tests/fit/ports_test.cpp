// A valve on a test stand: ports blocked or joined in place of the actuator, the two stages as ever.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/edge_radius.h"
#include "effects/flow_meter_lag.h"
#include "effects/port_line.h"
#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/ports_of.h"
#include "fit/support.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

constexpr double rated = 0.02;  // [A]

// A triangle of +-`amplitude` with a period, from the shipped table.
Scenario stand(Ports ports, double amplitude, double period, double rate, double cycles = 1.25) {
  Scenario s;
  s.ports = ports;
  s.rated_current = rated;
  s.command_slope = 1.0;
  for (double t = 0; t <= cycles * period; t += 1 / rate) {
    const double turn = t / period + 0.25;
    s.time.push_back(t);
    s.command.push_back(amplitude * (1 - 4 * std::fabs(turn - std::floor(turn) - 0.5)));
  }
  return s;
}
const std::vector<double>& of(const Trajectory& t, Signal s) { return t.signals[simulated_index(s)]; }
SimulateOptions all_signals() {
  SimulateOptions o;
  o.wanted.fill(true);
  return o;
}
double largest(const std::vector<double>& x) {
  double m = 0;
  for (double v : x) m = std::max(m, std::fabs(v));
  return m;
}

TEST(TestStand, BlockedPortsReachTheSupply) {
  ParameterVector v = candidate_of(shipped_table());
  v[row::hose_compliance] = 0;  // slow and stiff, or what the ports swallow and give back is in the leakage
  const double supply = v[row::supply_pressure] - v[row::return_pressure];
  const Trajectory t = simulate(stand(Ports::blocked, 0.2 * rated, 40, 100), v, all_signals());
  constexpr std::size_t quarter = 1000;
  ASSERT_TRUE(t.ok);
  EXPECT_NEAR(largest(of(t, Signal::load_pressure)), supply, 0.02 * supply);
  // Positive command raises A.
  EXPECT_GT(of(t, Signal::load_pressure)[quarter], 0.9 * supply);
  // The leakage peaks about null. Just off it turbulent edges pass a little more: the covered one has the whole drop
  // before its land resists.
  const auto& leakage = of(t, Signal::leakage_flow);
  const auto peak = static_cast<std::size_t>(std::max_element(leakage.begin(), leakage.end()) - leakage.begin());
  EXPECT_LT(std::fabs(of(t, Signal::spool_position)[peak]), 0.01 * v[row::spool_stop]);
  EXPECT_GT(leakage[2 * quarter], 0.95 * leakage[peak]);
  EXPECT_GT(leakage[peak], 1.05 * leakage[quarter]);
}

TEST(TestStand, WhatABlockedPortSwallowsIsWhatItsPressureStores) {
  ParameterVector v = candidate_of(shipped_table());
  v[row::air_fraction] = 0;
  const Trajectory t = simulate(stand(Ports::blocked, 0.2 * rated, 100, 100, 0.75), v, all_signals());
  ASSERT_TRUE(t.ok);
  const double compliance = v[row::dead_volume_a] / v[row::bulk_modulus] + v[row::hose_compliance];
  const auto &p = of(t, Signal::pressure_a), &q = of(t, Signal::flow_a);
  // From the end of the rise to the end of the fall, by the trapezoid rule at the samples.
  double swallowed = 0;
  for (std::size_t k = 2500; k + 1 < p.size(); ++k) swallowed += 0.5 * (q[k] + q[k + 1]) * 0.01;
  const double stored = compliance * (p.back() - p[2500]);
  EXPECT_NEAR(swallowed, stored, 0.01 * std::fabs(stored));
}

TEST(TestStand, FreePortsHoldNoLoadPressureAndPassTheNoLoadFlow) {
  const ParameterVector v = candidate_of(shipped_table());
  const Scenario s = stand(Ports::free, rated, 10, 100);
  const Trajectory t = simulate(s, v, all_signals());
  ASSERT_TRUE(t.ok);
  EXPECT_LT(largest(of(t, Signal::load_pressure)), 0.02 * v[row::supply_pressure]);
  // Half the supply differential over each sharp edge (Merritt 1967 ch. 5).
  const double drop = 0.5 * (v[row::supply_pressure] - v[row::return_pressure]);
  for (std::size_t k : {250, 750}) {
    const double by_orifice =
        0.61 * v[row::port_width] * of(t, Signal::spool_position)[k] * std::sqrt(2 * drop / s.oil.density);
    EXPECT_NEAR(of(t, Signal::control_flow)[k], by_orifice, 0.03 * std::fabs(by_orifice));
  }
}

TEST(TestStand, LessOverlapIsASteeperLoadPressureAndMoreLeakageAtNull) {
  // Overlapped edges leave the ports to the leakage of their slots, whose lengths change little with the spool.
  double last_slope = 1e99, last_leakage = 1e99;
  for (double lap : {-4e-6, 0.0, 4e-6, 8e-6}) {
    ParameterVector v = candidate_of(shipped_table());
    for (int r : {row::lap_pa, row::lap_pb, row::lap_at, row::lap_bt}) v[r] = lap;
    const Trajectory t = simulate(stand(Ports::blocked, 0.05 * rated, 40, 100), v, all_signals());
    ASSERT_TRUE(t.ok);
    // The falling branch passes null at 20 s.
    const auto& p = of(t, Signal::load_pressure);
    double slope = 0;
    for (std::size_t k = 1000; k + 20 < 3000; ++k) slope = std::max(slope, p[k] - p[k + 20]);
    const double leakage = of(t, Signal::leakage_flow)[2000];
    EXPECT_LT(slope, last_slope) << lap;
    EXPECT_LT(leakage, last_leakage) << lap;
    last_leakage = leakage;
    last_slope = slope;
  }
}

TEST(TestStand, ACreepingSweepCostsAStepASampleAndLosesNothing) {
  ParameterVector v = candidate_of(shipped_table());
  for (double volume : {2e-5, 1e-3}) {
    v[row::dead_volume_a] = v[row::dead_volume_b] = volume;
    const Scenario s = stand(Ports::blocked, 0.2 * rated, 40, 100);
    SimulateOptions fine = all_signals();
    fine.creep_step = fine.step;
    const Trajectory coarse = simulate(s, v, all_signals()), exact = simulate(s, v, fine);
    for (Signal signal : {Signal::load_pressure, Signal::leakage_flow, Signal::spool_position}) {
      double worst = 0;
      for (std::size_t k = 0; k < s.time.size(); ++k)
        worst = std::max(worst, std::fabs(of(coarse, signal)[k] - of(exact, signal)[k]));
      EXPECT_LT(worst, 5e-3 * largest(of(exact, signal))) << info(signal).name << ' ' << volume;
    }
  }
}

TEST(TestStand, AFlowMetersLagDelaysARampByItself) {
  ParameterVector v = candidate_of(shipped_table());
  const Scenario s = stand(Ports::free, rated, 40, 100);
  const Trajectory prompt = simulate(s, v, all_signals());
  constexpr double lag = 0.5;
  v[effect_row<FlowMeterLag>(0)] = lag;
  const Trajectory late = simulate(s, v, all_signals());
  const std::size_t at = 800, behind = static_cast<std::size_t>(lag * 100);  // on the ramp
  EXPECT_NEAR(of(late, Signal::control_flow)[at], of(prompt, Signal::control_flow)[at - behind],
              0.01 * largest(of(prompt, Signal::control_flow)));
  EXPECT_NEAR(of(late, Signal::spool_position)[at], of(prompt, Signal::spool_position)[at], 1e-12);
}

TEST(TestStand, BluntEdgesLeakAtNullAndPassTheSameFlowWhenOpen) {
  ParameterVector v = candidate_of(shipped_table());
  const Scenario shut = stand(Ports::blocked, 0.2 * rated, 100, 50), open = stand(Ports::free, rated, 10, 100);
  double last = 0;
  const double flow = of(simulate(open, v, all_signals()), Signal::control_flow)[250];
  for (double radius : {0.0, 5e-6, 10e-6, 20e-6}) {
    v[effect_row<EdgeRadius>(0)] = v[effect_row<EdgeRadius>(1)] = radius;
    const Trajectory t = simulate(shut, v, all_signals());
    ASSERT_TRUE(t.ok);
    const double null_leakage = largest(of(t, Signal::leakage_flow));
    EXPECT_GT(null_leakage, last) << radius;
    last = null_leakage;
    EXPECT_NEAR(of(simulate(open, v, all_signals()), Signal::control_flow)[250], flow, 0.01 * flow) << radius;
  }
}

TEST(TestStand, AVolumeBehindARestrictionEmptiesIntoTheReturnLineInItsOwnTime) {
  ParameterVector v = candidate_of(shipped_table());
  Scenario s = stand(Ports::blocked, 0, 1, 100, 0);
  s.time.clear(), s.command.clear();
  for (int k = 0; k < 4000; ++k) {  // A under pressure for 10 s, then open to return
    s.time.push_back(0.01 * k);
    s.command.push_back(k < 1000 ? 0.2 * rated : -0.2 * rated);
  }
  const Trajectory without = simulate(s, v, all_signals());
  constexpr double compliance = 1e-12, time = 3.0;
  v[effect_row<PortLine>(0)] = compliance;
  v[effect_row<PortLine>(2)] = time;
  const Trajectory with = simulate(s, v, all_signals());
  ASSERT_TRUE(with.ok);
  const auto excess = [&](std::size_t k) {
    return of(with, Signal::leakage_flow)[k] - of(without, Signal::leakage_flow)[k];
  };
  EXPECT_NEAR(excess(999), 0.0, 1e-3 * of(without, Signal::leakage_flow)[999]);  // at rest it takes no part
  double returned = 0;
  for (std::size_t k = 1000; k + 1 < 4000; ++k) returned += 0.5 * (excess(k) + excess(k + 1)) * 0.01;
  const double held = compliance * (of(with, Signal::pressure_a)[999] - of(with, Signal::pressure_a).back());
  EXPECT_NEAR(returned, held, 0.02 * held);
  EXPECT_NEAR(excess(1300 + 100) / excess(1000 + 100), std::exp(-1.0), 0.03);
}

Log bench_log(std::initializer_list<Signal> signals) {
  Log log;
  for (int k = 0; k < 50; ++k) log.time.push_back(0.01 * k);
  log.channels[index(Signal::command)].value.assign(50, 0.0);
  for (Signal s : signals) log.channels[index(s)].value.assign(50, 1.0);
  return log;
}

TEST(TestStand, TheLogSaysWhichWayThePortsWere) {
  RigFile rig;
  EXPECT_EQ(ports_of(bench_log({Signal::piston_position, Signal::load_pressure}), rig), Ports::actuator);
  EXPECT_EQ(ports_of(bench_log({Signal::leakage_flow}), rig), Ports::blocked);
  EXPECT_EQ(ports_of(bench_log({Signal::control_flow}), rig), Ports::free);
  for (Ports ports : {Ports::blocked, Ports::free}) {
    rig.ports = ports;
    EXPECT_EQ(ports_of(bench_log({Signal::leakage_flow}), rig), Ports::blocked);
    EXPECT_EQ(ports_of(bench_log({Signal::load_pressure}), rig), Ports::blocked);
    EXPECT_EQ(ports_of(bench_log({Signal::control_flow}), rig), Ports::free);
    EXPECT_EQ(ports_of(bench_log({Signal::spool_position}), rig), ports);
  }
}

TEST(TestStand, FreePortsTakeTheRatedDropWhereNoSupplyIsLogged) {
  RigFile rig;
  rig.ports = Ports::free;
  rig.facts["valve.rated_pressure_drop"] = 7e6;
  rig.facts["supply.return_pressure"] = 1e5;
  const LogData data = prepare(bench_log({Signal::control_flow}), rig);
  ASSERT_EQ(data.notes.size(), 1u);
  EXPECT_EQ(data.notes.front().kind, Note::Kind::no_supply);
  EXPECT_DOUBLE_EQ(data.scenario.supply_pressure.front() - data.scenario.return_pressure.front(), 7e6);
  const LogData blocked = prepare(bench_log({Signal::leakage_flow}), rig);
  EXPECT_TRUE(blocked.scenario.supply_pressure.empty());
  ASSERT_EQ(blocked.notes.size(), 1u);
  EXPECT_EQ(blocked.notes.front().kind, Note::Kind::test_stand);
}

}  // namespace
}  // namespace servodx
