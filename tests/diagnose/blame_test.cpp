#include "diagnose/blame.h"

#include <gtest/gtest.h>

#include "diagnose/broken_sensors.h"
#include "diagnose/decide.h"
#include "diagnose/judge.h"
#include "diagnose/judgeable.h"
#include "diagnose/naming.h"
#include "diagnose/record_law.h"
#include "faults/registry.h"

namespace servodx {
namespace {

Diagnosis of_fault(const char* label) {
  Diagnosis d;
  d.verdict = VerdictKind::fault;
  d.fault = find_fault(label);
  EXPECT_TRUE(d.fault) << label;
  return d;
}

Diagnosis unexplained() {
  Diagnosis d;
  d.verdict = VerdictKind::unknown;
  return d;
}

TEST(Blame, OfAHealthyLogIsNobodys) { EXPECT_EQ(blame_of({}), Blame::none); }

TEST(Blame, ThreeFaultsAreNotTheValves) {
  for (const char* label : {"sensor_fault", "supply_fault", "driver_fault"})
    EXPECT_EQ(blame_of(of_fault(label)), Blame::surroundings) << label;
  for (const char* label :
       {"clogged_filter", "torque_motor_loss", "feedback_wire_backlash", "feedback_wire_lost", "sticky_spool",
        "radial_clearance_wear", "null_shift", "plugged_nozzle", "cylinder_leakage", "corner_wear"})
    EXPECT_EQ(blame_of(of_fault(label)), Blame::component) << label;
}

TEST(Blame, AnUnknownStateIsPhysicsOnlyWhereACauseWasTaken) {
  Diagnosis d = unexplained();
  EXPECT_EQ(blame_of(d), Blame::test) << "explain was not asked";
  d.beyond = BeyondFaults{"stiction", "spool", "", 0.4, false};
  EXPECT_EQ(blame_of(d), Blame::test) << "healthy logs show it too";
  d.beyond->taken = true;
  EXPECT_EQ(blame_of(d), Blame::physics);
  d.beyond->outside = true;
  EXPECT_EQ(blame_of(d), Blame::surroundings) << "a cause of a sensor or of the driver is no physics of the valve";
}

TEST(Blame, WhatTheRigFileOrTheWiringMendsIsOfTheLog) {
  Diagnosis sensor = of_fault("sensor_fault");
  const auto by = [&](SensorFinding finding) {
    RecordFinding record;
    record.fault = sensor.fault, record.broken = finding;
    sensor.faults = {{sensor.fault, 1, 0, 0, 0, record}};
    return blame_of(sensor);
  };
  EXPECT_EQ(by(SensorFinding::turned), Blame::log);
  EXPECT_EQ(by(SensorFinding::swapped_ports), Blame::log);
  EXPECT_EQ(by(SensorFinding::frozen), Blame::surroundings);
  EXPECT_EQ(by(SensorFinding::clipped), Blame::surroundings);
  Diagnosis unknown = unexplained();
  unknown.doubt = Doubt::misread;
  EXPECT_EQ(blame_of(unknown), Blame::log);
  unknown.doubt = Doubt::unjudgeable, unknown.assessment.unjudgeable = Unjudgeable::pressures_out_of_order;
  EXPECT_EQ(blame_of(unknown), Blame::log);
}

TEST(Blame, NothingToJudgeAsksForATest) {
  Diagnosis d = unexplained();
  d.assessment.unjudgeable = Unjudgeable::nothing_asked;
  EXPECT_EQ(blame_of(d), Blame::test);
}

}  // namespace
}  // namespace servodx
