// A valve on a test stand: ports blocked or joined in place of the actuator, the two stages as ever.
#include <gtest/gtest.h>

#include <cmath>

#include "effects/registry.h"
#include "fit/support.h"

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

TEST(TestStand, BlockedPortsReachTheSupplyAndPassNoFlow) {
  const ParameterVector v = candidate_of(shipped_table());
  const double supply = v[row::supply_pressure] - v[row::return_pressure];
  const Trajectory t = simulate(stand(Ports::blocked, 0.2 * rated, 10, 100), v, all_signals());
  ASSERT_TRUE(t.ok);
  EXPECT_NEAR(largest(of(t, Signal::load_pressure)), supply, 0.02 * supply);
  // What the chambers swallow as their pressure changes is all.
  EXPECT_LT(largest(of(t, Signal::control_flow)), 1e-3 * 14 / 6e4);
  // Positive command raises A.
  EXPECT_GT(of(t, Signal::load_pressure)[250], 0.9 * supply);
  // The leakage peaks where the load pressure passes zero.
  const auto& leakage = of(t, Signal::leakage_flow);
  const auto peak = static_cast<std::size_t>(std::max_element(leakage.begin(), leakage.end()) - leakage.begin());
  EXPECT_LT(std::fabs(of(t, Signal::load_pressure)[peak]), 0.3 * supply);
  EXPECT_GT(leakage[peak], 1.05 * leakage[250]);
}

TEST(TestStand, FreePortsHoldNoLoadPressureAndPassTheNoLoadFlow) {
  const ParameterVector v = candidate_of(shipped_table());
  const Trajectory t = simulate(stand(Ports::free, rated, 10, 100), v, all_signals());
  ASSERT_TRUE(t.ok);
  EXPECT_LT(largest(of(t, Signal::load_pressure)), 0.02 * v[row::supply_pressure]);
  // 14 l/min at rated current: the value that the table's port width was made from.
  EXPECT_NEAR(of(t, Signal::control_flow)[250], 14 / 6e4, 0.05 * 14 / 6e4);
  EXPECT_NEAR(of(t, Signal::control_flow)[750], -14 / 6e4, 0.05 * 14 / 6e4);
}

TEST(TestStand, ACreepingSweepCostsAStepASampleAndLosesNothing) {
  const ParameterVector v = candidate_of(shipped_table());
  const Scenario s = stand(Ports::blocked, 0.1 * rated, 40, 100);
  SimulateOptions fine = all_signals();
  fine.creep_step = fine.step;
  const Trajectory coarse = simulate(s, v, all_signals()), exact = simulate(s, v, fine);
  for (Signal signal : {Signal::load_pressure, Signal::leakage_flow, Signal::spool_position}) {
    double worst = 0;
    for (std::size_t k = 0; k < s.time.size(); ++k)
      worst = std::max(worst, std::fabs(of(coarse, signal)[k] - of(exact, signal)[k]));
    EXPECT_LT(worst, 2e-3 * largest(of(exact, signal))) << info(signal).name;
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
  EXPECT_EQ(of(late, Signal::load_pressure), of(prompt, Signal::load_pressure));
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
  EXPECT_DOUBLE_EQ(data.scenario.supply_pressure.front() - data.scenario.return_pressure.front(), 7e6);
  EXPECT_TRUE(prepare(bench_log({Signal::leakage_flow}), rig).scenario.supply_pressure.empty());
}

}  // namespace
}  // namespace servodx
