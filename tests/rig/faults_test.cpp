// Each fault starts from nothing and moves what physics says it moves.
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "base/error.h"
#include "rig/excitations.h"
#include "rig/plant.h"
#include "rig/rig_faults.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "rig/virtual_rig.h"
#include "rig/wear.h"
#include "rig_test_support.h"

namespace servodx::rig {
namespace {

constexpr double rated = 0.020;

// [s] from a step of current to 63 % of its spool travel
double rise_time(const Conditions& conditions, double command) {
  VirtualRig rig = settled(conditions);
  VirtualRig end = rig;
  hold(end, command, 0.2);
  const double start = rig.state()[x_spool], goal = start + 0.63 * (end.state()[x_spool] - start);
  const double h = rig.model().solver_step;
  double t = 0.0;
  while (rig.state()[x_spool] < goal && t < 0.2) {
    rig.step(command, 0.0, 0.0, h);
    t += h;
  }
  return t;
}

double spool_after(const Conditions& conditions, double command, double seconds = 0.1) {
  VirtualRig rig = settled(conditions);
  hold(rig, command, seconds);
  return rig.state()[x_spool];
}

// Spool position difference between coming from above and from below, at the same current.
double branch_difference(const Conditions& conditions) {
  VirtualRig up = settled(conditions), down = settled(conditions);
  hold(up, -0.2 * rated, 0.1);
  hold(down, 0.2 * rated, 0.1);
  const double h = up.model().solver_step;
  for (int i = 0; i < 50000; ++i) {
    const double u = 0.2 * rated * (1.0 - i / 50000.0);
    up.step(-u, 0.0, 0.0, h);
    down.step(u, 0.0, 0.0, h);
  }
  hold(up, 0.0, 0.05);
  hold(down, 0.0, 0.05);
  return down.state()[x_spool] - up.state()[x_spool];
}

TEST(RigFaults, HealthySeverityIsBitForBitNoFault) {
  const RigRun healthy{.excitation = "mixed", .duration = 0.3};
  const auto expected = run_rig(flight_rig(), healthy);
  for (const auto& fault : rig_faults()) {
    for (const double onset : {-1.0, 0.1}) {
      RigRun run = healthy;
      run.faults[fault.name] = fault.healthy;
      run.onset = onset;
      const auto log = run_rig(flight_rig(), run);
      for (std::size_t c = 0; c < log.columns.size(); ++c) {
        EXPECT_EQ(log.columns[c].value, expected.columns[c].value) << fault.name << " column " << c;
      }
    }
  }
}

TEST(RigFaults, ASmallFaultChangesLittleAndALargerOneMore) {
  const auto spool = [](const FaultSet& faults) {
    return run_rig(flight_rig(), {.excitation = "mixed", .duration = 0.6, .faults = faults, .noise = false})
        .columns[2]
        .value;
  };
  const auto healthy = spool({});
  const auto distance = [&](const std::vector<double>& x) {
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) sum += (x[k] - healthy[k]) * (x[k] - healthy[k]);
    return std::sqrt(sum / static_cast<double>(x.size()));
  };
  for (const auto& fault : rig_faults()) {
    const double tiny = distance(spool({{fault.name, fault.healthy + 0.01 * (fault.severity[0] - fault.healthy)}}));
    const double mild = distance(spool({{fault.name, fault.severity[0]}}));
    const double severe = distance(spool({{fault.name, fault.severity[2]}}));
    EXPECT_LT(tiny, 0.3 * mild + 1e-7) << fault.name;
    EXPECT_LT(mild, severe) << fault.name;
    EXPECT_GT(severe, 0.0) << fault.name;
  }
}

TEST(RigFaults, CloggedFilterLowersPilotPressureAndSlowsTheSpool) {
  const VirtualRig healthy = settled(), clogged = settled(with_fault("clogged_filter=severe"));
  EXPECT_LT(clogged.state()[p_pilot_1], 0.9 * healthy.state()[p_pilot_1]);
  EXPECT_LT(clogged.state()[p_pilot_2], 0.9 * healthy.state()[p_pilot_2]);
  EXPECT_GT(rise_time(with_fault("clogged_filter=severe"), rated), 1.05 * rise_time({}, rated));
}

TEST(RigFaults, TorqueMotorLossShrinksTheSpoolTravelByTheGainLost) {
  const double healthy = spool_after({}, 0.8 * rated) - spool_after({}, 0.0);
  const auto half = with_fault("torque_motor_loss=0.5");
  EXPECT_NEAR((spool_after(half, 0.8 * rated) - spool_after(half, 0.0)) / healthy, 0.5, 0.03);
}

TEST(RigFaults, BacklashWidensHysteresisByItsClearance) {
  const double healthy = branch_difference({});
  EXPECT_NEAR(branch_difference(with_fault("feedback_wire_backlash=20e-6")) - healthy, 20e-6, 4e-6);
}

TEST(RigFaults, LostFeedbackDrivesTheSpoolToItsStop) {
  // A fifth of rated current: far less is held by flow force before the stop, and none at all by friction near null.
  const double stop = flight_rig().spool_stop;
  EXPECT_NEAR(spool_after(with_fault("feedback_wire_lost=0"), 0.2 * rated), stop, 0.02 * stop);
  EXPECT_NEAR(spool_after(with_fault("feedback_wire_lost=0"), -0.2 * rated), -stop, 0.02 * stop);
}

TEST(RigFaults, HalfAWireDoublesTheSpoolTravel) {
  const auto half = with_fault("feedback_wire_lost=0.5");
  const double healthy = spool_after({}, 0.2 * rated) - spool_after({}, 0.0);
  EXPECT_NEAR((spool_after(half, 0.2 * rated) - spool_after(half, 0.0)) / healthy, 2.0, 0.15);
}

TEST(RigFaults, StickySpoolWidensTheThreshold) {
  EXPECT_GT(branch_difference(with_fault("sticky_spool=severe")), branch_difference({}) + 5e-6);
}

TEST(RigFaults, WornClearanceLeaksMoreAtNull) {
  const VirtualRig healthy = settled(), worn = settled(with_fault("radial_clearance_wear=severe"));
  EXPECT_GT(worn.flows().q_pa + worn.flows().q_pb, 5.0 * (healthy.flows().q_pa + healthy.flows().q_pb));
}

TEST(RigFaults, NullShiftMovesTheSpoolByThatMuchCurrent) {
  const double shifted = spool_after(with_fault("null_shift=0.12"), 0.0);
  EXPECT_NEAR(shifted, spool_after({}, 0.12 * rated), 3e-6);
}

TEST(RigFaults, OnsetLeavesTheLogBeforeItUntouched) {
  const RigRun healthy{.excitation = "mixed", .duration = 0.4};
  RigRun late = healthy;
  late.faults = {{"torque_motor_loss", 0.5}};
  late.onset = 0.2;
  const auto a = run_rig(flight_rig(), healthy), b = run_rig(flight_rig(), late);
  const auto &x = a.columns[2].value, &y = b.columns[2].value;
  EXPECT_TRUE(std::equal(x.begin(), x.begin() + 200, y.begin()));
  EXPECT_NE(x.back(), y.back());
  EXPECT_EQ(b.truth["onset_time"], 0.2);
}

TEST(RigFaults, AGrowingFaultMovesInProportionToItsTime) {
  FaultSet faults;
  add_fault("sticky_spool=11@2..12", faults);
  add_fault("clogged_filter=severe@3", faults);
  EXPECT_EQ(wear_of(faults, 1.0).spool_friction, 1.0);
  EXPECT_DOUBLE_EQ(wear_of(faults, 7.0).spool_friction, 6.0);
  EXPECT_EQ(wear_of(faults, 20.0).spool_friction, 11.0);
  EXPECT_EQ(wear_of(faults, 2.9).filter_blocked, 0.0);
  EXPECT_EQ(wear_of(faults, 3.0).filter_blocked, 0.75);
  EXPECT_EQ(wear_of(faults).filter_blocked, 0.75);
}

// Fig. 12 of the prognostic paper: the clearance wears with its corners.
TEST(RigFaults, WornEdgesAreAClearanceAndCornersByOneSeverity) {
  const auto worn = [](double times) { return wear_of({{"edge_wear", {times}}}); };
  EXPECT_EQ(worn(1).corner_wear, 0.0);
  const std::vector<std::pair<double, double>> of_the_paper{{3, 4e-6}, {6, 10e-6}, {10, 40e-6}};
  for (const auto& [times, corners] : of_the_paper) {
    EXPECT_EQ(worn(times).edge_clearance, times);
    EXPECT_NEAR(worn(times).corner_wear, corners, 1e-18) << times;
  }
  for (double times = 1; times < 20; times += 0.5) EXPECT_GT(worn(times + 0.5).corner_wear, worn(times).corner_wear);
  EXPECT_NEAR(worn(12).corner_wear, 55e-6, 1e-18) << "beyond the last point its slope goes on";
  FaultSet growing;
  add_fault("edge_wear=6@2..12", growing);
  EXPECT_EQ(wear_of(growing, 1.0).corner_wear, 0.0);
  EXPECT_DOUBLE_EQ(wear_of(growing, 6.0).edge_clearance, 3.0);
  EXPECT_NEAR(wear_of(growing, 6.0).corner_wear, 4e-6, 1e-18);
}

TEST(RigFaults, WornEdgesAreAWornClearanceToADiagnosis) {
  EXPECT_EQ(label_of("edge_wear"), "radial_clearance_wear");
  const Wear alone = wear_of({{"radial_clearance_wear", {6.0}}});
  EXPECT_EQ(alone.edge_clearance, 6.0);
  EXPECT_EQ(alone.corner_wear, 0.0) << "the label is another fault's name";
  FaultSet faults;
  add_fault("edge_wear=medium", faults);
  for (const char* same : {"radial_clearance_wear=3", "corner_wear=5e-6"})
    EXPECT_THROW(add_fault(same, faults), InputError) << same;
  add_fault("null_shift=0.1", faults);
}

TEST(RigFaults, CombinedFaultsMoveTheSumOfWhatEachMoves) {
  const Wear both = with_faults({"null_shift=0.1", "feedback_wire_backlash=1e-5"}).wear;
  EXPECT_EQ(both.null, 0.1);
  EXPECT_EQ(both.wire_clearance, 1e-5);
  const double shift = spool_after(with_fault("null_shift=0.1"), 0.0) - spool_after({}, 0.0);
  EXPECT_NEAR(spool_after(with_faults({"null_shift=0.1", "clogged_filter=0.5"}), 0.0) - spool_after({}, 0.0), shift,
              2e-6);
}

TEST(RigFaults, AnOpenCoilLeavesNoCurrentAndASpoolAtNull) {
  VirtualRig rig = settled(with_fault("open_coil=0"));
  hold(rig, rated, 0.1);
  EXPECT_LT(std::fabs(rig.state()[current]), 0.01 * rated);
  EXPECT_LT(std::fabs(rig.state()[x_spool]), 0.03 * flight_rig().spool_stroke);
}

TEST(RigFaults, AnOpenCoilOfTwoInParallelLeavesTheOtherToCarryTheCurrent) {
  RigModel parallel = flight_rig();
  set_value(parallel, "coil_wiring=parallel");
  set_value(parallel, "driver.rated_current=0.04");
  VirtualRig rig(parallel, with_fault("open_coil=0"));
  hold(rig, 0.02, 0.2);
  EXPECT_NEAR(rig.state()[current], 0.02, 1e-4);
}

TEST(RigFaults, APluggedNozzleDrivesTheSpoolTowardsItsSideAndSlewsUnevenly) {
  // Nozzle 1 shut: pilot pressure 1 rises, the spool moves positive until the wire balances it.
  EXPECT_GT(spool_after(with_fault("plugged_nozzle=0.5"), 0.0), spool_after({}, 0.0) + 5e-6);
  EXPECT_LT(spool_after(with_fault("plugged_nozzle=-0.5"), 0.0), spool_after({}, 0.0) - 5e-6);
}

TEST(RigFaults, AChipHoldsTheSpoolWhereItIs) {
  VirtualRig rig = settled();
  hold(rig, 0.3 * rated, 0.1);
  const double before = rig.state()[x_spool];
  rig.set_wear(with_fault("spool_jam=1000").wear);
  hold(rig, -rated, 0.1);
  EXPECT_NEAR(rig.state()[x_spool], before, 3e-6);
}

TEST(RigFaults, AWornPistonSealLeaksInProportionToTheLoadPressure) {
  const auto conductance = [](const Conditions& conditions) {
    VirtualRig rig = settled(conditions);
    hold(rig, 0.0, 0.1, 8000.0);
    return rig.flows().q_across / (rig.state()[p_a] - rig.state()[p_b]);
  };
  EXPECT_NEAR(conductance({}), flight_rig().actuator_leakage, 0.2 * flight_rig().actuator_leakage);
  EXPECT_NEAR(conductance(with_fault("cylinder_leakage=1e-11")), 1e-11, 2e-12);  // thicker under pressure
}

TEST(RigFaults, OilOfHalfTheViscosityLeaksTwiceAsMuchThroughTheSameSeal) {
  const auto conductance = [](double viscosity) {
    VirtualRig rig = settled({.viscosity = viscosity});
    hold(rig, 0.0, 0.1, 8000.0);
    return rig.flows().q_across / (rig.state()[p_a] - rig.state()[p_b]);
  };
  EXPECT_NEAR(conductance(0.5) / conductance(1.0), 2.0, 0.02);
}

TEST(RigFaults, ASaggingSupplyLowersTheSupplyPressure) {
  EXPECT_NEAR(settled(with_fault("supply_fault=0.5")).state()[p_supply], 0.5 * flight_rig().supply_pressure, 3e5);
}

TEST(RigFaults, ADriftedSensorGainScalesThePistonReading) {
  RigRun run{.excitation = "steps_large", .duration = 0.5, .noise = false, .channels = {"piston_position"}};
  const auto healthy = run_rig(flight_rig(), run, make_stimulus("preflight", flight_rig(), {}));
  run.faults = {{"sensor_fault", 0.8}};
  const auto drifted = run_rig(flight_rig(), run, make_stimulus("preflight", flight_rig(), {}));
  const double a = healthy.columns[2].value.back(), b = drifted.columns[2].value.back();
  EXPECT_NEAR(b / a, 0.8, 0.03);
}

TEST(RigFaults, WornSealsWidenTheBandInWhichThePistonStands) {
  // A load of twice the healthy breakaway moves the rod through the seals' band; ten times the friction holds it.
  const auto moved = [](const Conditions& conditions) {
    VirtualRig rig(flight_rig(), conditions);
    hold(rig, 0.0, 0.1);
    const Flows f = [&] {
      hold(rig, 0.02 * rated, 0.2);
      return rig.flows();
    }();
    return std::fabs(f.piston_friction);
  };
  EXPECT_GT(moved(with_fault("seal_friction=severe")), 3.0 * moved({}));
}

std::string refusal(const auto& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(RigFaults, UnknownNamesAreRefusedWithTheListOfNames) {
  FaultSet faults;
  const auto fault = refusal([&] { add_fault("rusty_spool=1", faults); });
  EXPECT_NE(fault.find("clogged_filter, torque_motor_loss, feedback_wire_backlash"), std::string::npos) << fault;
  const auto excitation = refusal([] { run_rig(flight_rig(), {.excitation = "noise"}); });
  EXPECT_NE(excitation.find("steps_large, steps_small, sine"), std::string::npos) << excitation;
  EXPECT_NE(refusal([&] { add_fault("clogged_filter=2", faults); }).find("outside 0 to 0.999"), std::string::npos);
  EXPECT_NE(refusal([&] { add_fault("clogged_filter", faults); }).find("clogged_filter=medium"), std::string::npos);
  EXPECT_NE(refusal([] { run_rig(flight_rig(), {.channels = {"setpoint"}}); }).find("--channels"), std::string::npos);
}

}  // namespace
}  // namespace servodx::rig
