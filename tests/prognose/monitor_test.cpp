// The monitor of Borello 2009, Fig. 5.
#include "prognose/monitor.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "model/state.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/monitor.h"
#include "support.h"

namespace servodx {
namespace {

MonitorParameters shipped(double supply = 207e5, double return_pressure = 5e5) {
  Supply at;
  at.supply = supply, at.return_ = return_pressure;
  at.oil = oil_at(860, 14e-6, 313.15);
  return monitor_parameters(shipped_table(), at);
}

// With the figure's own law of the pressure.
Monitor linear(const MonitorParameters& p) { return {p, linear_pressure(p)}; }

TEST(Monitor, RatedCurrentReachesTheRatedStrokeAndNoLoadSpeed) {
  const MonitorParameters p = shipped();
  Monitor monitor = linear(p);
  for (int k = 0; k < 200; ++k) monitor.step(0.02, 0.0, 1e-3);
  EXPECT_NEAR(monitor.spool(), 0.5e-3, 0.06e-3);  // the flow force takes some of it
  EXPECT_NEAR(monitor.speed(), 0.3, 0.06);
}

TEST(Monitor, StallsAtTheForceOfTheDataSheet) {
  Monitor monitor = linear(shipped());
  for (int k = 0; k < 500; ++k) monitor.step(0.02, 15.9e3, 1e-3);  // below stall, moves
  EXPECT_GT(monitor.speed(), 0.0);
  for (int k = 0; k < 50; ++k) monitor.step(0.02, 16.5e3, 1e-3);  // above, is driven back
  EXPECT_LT(monitor.speed(), 0.0);
}

// The exact solution of the spool does not depend on the step, nor does an implicit piston blow up at any.
TEST(Monitor, SpoolIsTheSameAtEveryStepAndThePistonConvergesInFirstOrder) {
  const MonitorParameters p = shipped();
  const auto end_of = [&](double h) {
    Monitor m = linear(p);
    const int n = static_cast<int>(std::lround(0.02 / h));
    for (int k = 0; k < n; ++k) m.step(0.012, 2000.0, h);
    return std::pair(m.spool(), m.piston());
  };
  const auto fine = end_of(1e-6), a = end_of(1e-3), b = end_of(5e-4);
  EXPECT_NEAR(a.first, fine.first, 1e-12);
  EXPECT_NEAR(b.first, fine.first, 1e-12);
  EXPECT_NEAR((a.second - fine.second) / (b.second - fine.second), 2.0, 0.2);
}

TEST(Monitor, LimitsHoldOnFlapperSpoolPressureAndPiston) {
  const MonitorParameters p = shipped();
  Monitor monitor = linear(p);
  double before = 0;
  for (int k = 0; k < 3000; ++k) {
    monitor.step(0.05, 0.0, 1e-3);
    EXPECT_LE(monitor.spool() - before, p.first_stage_gain * p.flapper_limit * 1e-3 * (1 + 1e-12));
    EXPECT_LE(std::abs(monitor.pressure()), p.pressure_limit);
    before = monitor.spool();
  }
  EXPECT_EQ(monitor.spool(), p.spool_limit);
  EXPECT_EQ(monitor.piston(), p.piston_limit);
  EXPECT_EQ(monitor.speed(), 0.0);
}

TEST(Monitor, MirroredCurrentMirrorsMotion) {
  const MonitorParameters p = shipped();
  Monitor a = linear(p), b = a;
  for (int k = 0; k < 300; ++k) {
    const double u = 0.02 * std::sin(0.05 * k);
    a.step(u, 500.0, 1e-3), b.step(-u, -500.0, 1e-3);
  }
  EXPECT_DOUBLE_EQ(a.spool(), -b.spool());
  EXPECT_NEAR(a.piston(), -b.piston(), 1e-10);
}

TEST(Monitor, TheClosedLoopFollowsItsSetpoint) {
  MonitorParameters p = shipped();
  p.control_gain = 1.0;  // 1 mA/mm
  Monitor monitor = linear(p);
  for (int k = 0; k < 2000; ++k) monitor.step(monitor.demand(0.05), 0.0, 1e-3);
  EXPECT_NEAR(monitor.piston(), 0.05, 1e-4);
}

// What wear does to the parameters: the paper's reasons for r to rise.
TEST(Monitor, ACloggedFilterSlowsItAndAWeakMotorShortensIt) {
  Table table = shipped_table();
  Supply at;
  at.supply = 207e5, at.return_ = 5e5;
  const MonitorParameters clean = monitor_parameters(table, at);
  table[row::filter_blockage_positive].nominal = table[row::filter_blockage_negative].nominal = 0.9;
  EXPECT_LT(monitor_parameters(table, at).first_stage_gain, 0.9 * clean.first_stage_gain);
  EXPECT_LT(shipped(100e5).first_stage_gain, shipped().first_stage_gain);
}

// papers.md C: any valve map may stand in place of GP; unloaded and slow they all give the same motion.
TEST(Monitor, EveryValveMapPlugsIn) {
  const Table table = shipped_table();
  Supply at;
  at.supply = 207e5, at.return_ = 5e5;
  at.oil = oil_at(860, 14e-6, 313.15);
  const MonitorParameters p = monitor_parameters(table, at);
  for (const char* name : {"linear", "A", "C1", "C2", "C3", "C5", "bridge", "HF"}) {
    Monitor monitor(p, pressure_law(name, table, at));
    for (int k = 0; k < 300; ++k) monitor.step(0.01, 0.0, 1e-3);
    EXPECT_NEAR(monitor.speed(), 0.15, 0.05) << name;
    EXPECT_TRUE(std::isfinite(monitor.pressure())) << name;
  }
}

TEST(Monitor, AnUnknownPressureModelIsRefused) {
  Supply at;
  at.supply = 207e5;
  EXPECT_THROW(pressure_law("nonesuch", shipped_table(), at), InputError);
}

}  // namespace
}  // namespace servodx
