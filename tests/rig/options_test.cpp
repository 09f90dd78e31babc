// What a rig can be besides the shipped one: wiring, dither, test stand, jet pipe, tolerances, sensors, environment.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "base/error.h"
#include "rig/excitations.h"
#include "rig/plant.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "rig/virtual_rig.h"
#include "rig_test_support.h"
#include "servodx/log.h"

namespace servodx::rig {
namespace {

constexpr double rated = 0.020;

RigModel changed(std::initializer_list<std::string> changes) {
  RigModel m = flight_rig();
  for (const auto& change : changes) set_value(m, change);
  return m;
}

double spool_at(const RigModel& m, double command, const Conditions& conditions = {}) {
  VirtualRig rig(m, conditions);
  hold(rig, 0.0, 0.1);
  hold(rig, command, 0.15);
  return rig.state()[x_spool];
}

TEST(RigOptions, EveryWiringReachesTheStrokeAtItsRatedCurrent) {
  const double series = spool_at(flight_rig(), rated);
  for (const char* wiring : {"coil_wiring=parallel", "coil_wiring=single"}) {
    EXPECT_NEAR(spool_at(changed({wiring, "driver.rated_current=0.04"}), 2.0 * rated), series, 1e-6) << wiring;
  }
}

TEST(RigOptions, ADriverShortOfVoltageSlewsItsCurrent) {
  const auto rise = [](const RigModel& m) {  // [s] to 90 % of rated current
    VirtualRig rig(m, {});
    hold(rig, 0.0, 0.05);
    double t = 0.0;
    for (; rig.state()[current] < 0.9 * rated && t < 0.1; t += m.solver_step) rig.step(rated, 0.0, 0.0, m.solver_step);
    return t;
  };
  EXPECT_GT(rise(changed({"driver.voltage=10"})), 2.0 * rise(changed({"driver.voltage=100"})));
}

TEST(RigOptions, ASolverThatRunsAwayIsAnErrorAndNotALogOfHoles) {
  RigRun run;
  run.duration = 0.05;
  EXPECT_NO_THROW(run_rig(flight_rig(), run));
  run.step = 1e-4;  // far beyond what an explicit solver bears of a pilot chamber
  EXPECT_THROW(run_rig(flight_rig(), run), InputError);
}

TEST(RigOptions, DitherNarrowsTheHysteresisThatFrictionLeaves) {
  const auto loop = [](const RigModel& m) {
    VirtualRig up(m, {}), down(m, {});
    hold(up, -0.1 * rated, 0.1);
    hold(down, 0.1 * rated, 0.1);
    hold(up, 0.0, 0.1);
    hold(down, 0.0, 0.1);
    double mean = 0.0;
    for (int i = 0; i < 5000; ++i) {
      hold(up, 0.0, m.solver_step);
      hold(down, 0.0, m.solver_step);
      mean += (down.state()[x_spool] - up.state()[x_spool]) / 5000.0;
    }
    return mean;
  };
  const double without = loop(flight_rig());
  const double with = loop(changed({"driver.dither_amplitude=0.05", "driver.dither_frequency=250"}));
  EXPECT_GT(without, 0.0);
  EXPECT_LT(with, 0.6 * without);
}

TEST(RigOptions, FreePortsPassWhatOneEdgeLetsIn) {
  const RigModel m = changed({"ports=free"});
  VirtualRig rig(m, {});
  hold(rig, 0.5 * rated, 0.3);
  const Flows f = rig.flows();
  EXPECT_NEAR(f.q_a, f.q_across, 1e-3 * f.q_across);
  EXPECT_NEAR(f.q_b, -f.q_across, 1e-3 * f.q_across);
  EXPECT_LT(std::fabs(rig.state()[p_a] - rig.state()[p_b]), 2e5);
}

TEST(RigOptions, BlockedPortsTakeSupplyAndReturnPressure) {
  const RigModel m = changed({"ports=blocked"});
  VirtualRig rig(m, {});
  hold(rig, 0.3 * rated, 0.3);
  EXPECT_GT(rig.state()[p_a], 0.97 * rig.state()[p_supply]);
  EXPECT_LT(rig.state()[p_b], 0.05 * rig.state()[p_supply]);
  EXPECT_EQ(rig.piston_position(), 0.0);
}

TEST(RigOptions, TestStandLogsHaveItsSignals) {
  for (const auto& [ports, signal] :
       {std::pair{"ports=free", Signal::control_flow}, {"ports=blocked", Signal::leakage_flow}}) {
    const auto log = run_rig(changed({ports}), {.excitation = "triangle", .duration = 0.2});
    EXPECT_TRUE(std::any_of(log.columns.begin(), log.columns.end(), [&](const auto& c) { return c.signal == signal; }));
    EXPECT_LT(std::fabs(log.truth["balance"]["energy_error"].get<double>()), 1e-6);
  }
}

TEST(RigOptions, AClosedJetLeavesTheJetPipesSpoolDead) {
  const RigModel jet = read_rig_model(std::string(SERVODX_SOURCE_DIR) + "/params/rigs/jet_pipe.toml");
  const double sound = spool_at(jet, 0.5 * rated) - spool_at(jet, -0.5 * rated);
  EXPECT_GT(sound, 0.8 * jet.spool_stroke);
  const Conditions clogged = with_fault("plugged_nozzle=1");
  EXPECT_LT(std::fabs(spool_at(jet, 0.5 * rated, clogged) - spool_at(jet, -0.5 * rated, clogged)), 0.3 * sound);
}

TEST(RigOptions, NoTwoValvesAreAlikeAndTheFirstIsTheDefinition) {
  const RigModel& type = flight_rig();
  std::set<double> laps, magnets;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const RigModel m = another_valve(type, seed);
    laps.insert(m.edges_lap_pa);
    magnets.insert(m.motor_magnet_mmf);
    EXPECT_LT(std::fabs(m.edges_lap_pa - type.edges_lap_pa), 2.01e-6);
    EXPECT_EQ(m.actuator_bore, type.actuator_bore);  // no spread
  }
  EXPECT_GT(laps.size(), 45u);
  EXPECT_GT(magnets.size(), 45u);
  EXPECT_EQ(another_valve(type, 0).edges_lap_pa, type.edges_lap_pa);
  EXPECT_EQ(another_valve(type, 7).edges_lap_pa, another_valve(type, 7).edges_lap_pa);
}

TEST(RigOptions, PickUpIsASineAtMainsFrequency) {
  const RigModel m = changed({"sensors.spool_position.pickup=1e-4", "sensors.spool_position.noise=0"});
  const auto log =
      run_rig(m, {.excitation = "sine", .duration = 0.4, .amplitude = 1e-6, .channels = {"spool_position"}});
  const auto &x = log.columns[2].value, &t = log.columns[0].value;
  double in = 0.0, out = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    in += x[k] * std::sin(314.15926535897933 * t[k]) * 2.0 / static_cast<double>(x.size());
    out += x[k] * std::cos(314.15926535897933 * t[k]) * 2.0 / static_cast<double>(x.size());
  }
  EXPECT_NEAR(std::hypot(in, out), 1e-4, 5e-6);
}

TEST(RigOptions, FlightOffsetHasThreeTermsWithinTheirLimits) {
  double lowest = 1.0, highest = -1.0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto offset = borello_offset(seed, 300.0);
    double jump = 0.0;
    for (double t = 0.0; t < 300.0; t += 0.05) {
      lowest = std::min(lowest, offset(t));
      highest = std::max(highest, offset(t));
      jump = std::max(jump, std::fabs(offset(t + 0.05) - offset(t)));
    }
    EXPECT_GT(jump, 0.01) << seed;  // steps
    EXPECT_LT(jump, 0.07) << seed;
  }
  EXPECT_GE(lowest, 0.02 - 0.03 - 0.05 - 1e-12);
  EXPECT_LE(highest, 0.02 + 0.03 + 0.05 + 1e-12);
  EXPECT_GT(highest, 0.06);
  EXPECT_LT(lowest, -0.02);
}

TEST(RigOptions, OffsetActsBehindTheLoggedCommand) {
  const RigRun plain{.excitation = "sine", .duration = 0.2, .amplitude = 1e-6, .noise = false};
  RigRun with = plain;
  with.offset = true;
  const auto a = run_rig(flight_rig(), plain), b = run_rig(flight_rig(), with);
  const double expected = borello_offset(with.seed, with.duration)(0.1) * flight_rig().spool_stroke;
  EXPECT_NEAR(b.columns[2].value[100] - a.columns[2].value[100], expected, 0.25 * std::fabs(expected) + 3e-6);
}

TEST(RigOptions, CompensationBringsTheSpoolToNullBeforeThePreflightTest) {
  const RigRun run{.excitation = "preflight_full",
                   .duration = 0.4,
                   .faults = {{"null_shift", 0.12}},
                   .noise = false,
                   .channels = {"spool_position"}};
  // Within its lap the piston stands still: that is as near as the loop can find it.
  EXPECT_LT(std::fabs(run_rig(flight_rig(), run).columns[2].value.back()), flight_rig().edges_lap_pa);
  EXPECT_GT(std::fabs(run_rig(flight_rig(), run, make_stimulus("preflight", flight_rig(), {})).columns[2].value[50]),
            2e-5);
}

TEST(RigOptions, AStoppedLogEndsEarlyAndSaysSo) {
  const std::atomic<bool> stop{true};
  const auto log = run_rig(flight_rig(), {.excitation = "sine", .duration = 100.0, .stop = &stop});
  EXPECT_EQ(log.columns[0].value.size(), 0u);
  EXPECT_EQ(log.truth["interrupted"], true);
}

TEST(RigOptions, AFileMayStandOnAnotherAndBadOnesAreRefusedWithTheirPlace) {
  const RigModel jet = read_rig_model(std::string(SERVODX_SOURCE_DIR) + "/params/rigs/jet_pipe.toml");
  EXPECT_EQ(jet.spool_diameter, flight_rig().spool_diameter);
  EXPECT_EQ(jet.sensors.size(), flight_rig().sensors.size());
  const auto refusal = [](const std::string& change) -> std::string {
    RigModel m = flight_rig();
    try {
      set_value(m, change);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refusal("spool.weight=1").find("unknown key"), std::string::npos);
  EXPECT_NE(refusal("spool.mass=-1").find("is outside"), std::string::npos);
  EXPECT_NE(refusal("spool.mass=heavy").find("is no number"), std::string::npos);
  EXPECT_NE(refusal("ports=open").find("actuator, blocked, free"), std::string::npos);
  EXPECT_NE(refusal("sensors.spool_position.colour=1").find("known are"), std::string::npos);
}

}  // namespace
}  // namespace servodx::rig
