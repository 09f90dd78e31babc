// What leakage can press a land with, and a sticking spool's friction beside it (GA paper, sticky spool; Merritt 1967).
#include "diagnose/lateral_force.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnose/judge.h"
#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

// The film's equation itself: laminar flow along a gap that grows linearly, at each angle about the land.
TEST(LateralForce, IsTheIntegralOfTheFilmsPressure) {
  const double length = 6e-3, diameter = 6.5e-3, drop = 2e7, clearance = 3e-6;
  for (const double taper : {0.5e-6, 2.7e-6, 9e-6}) {
    constexpr int angles = 20000, along = 200;
    double force = 0;
    for (int a = 0; a < angles; ++a) {
      const double turn = 2 * std::numbers::pi * (a + 0.5) / angles;
      const double in = clearance * (1 + std::cos(turn)), out = in + taper;  // it touches at half a turn
      double mean = 0;
      for (int k = 0; k < along; ++k) {
        const double h = in + taper * (k + 0.5) / along;
        mean += drop * (1 / (h * h) - 1 / (out * out)) / (1 / (in * in) - 1 / (out * out)) / along;
      }
      force += mean * length * 0.5 * diameter * std::cos(turn) * 2 * std::numbers::pi / angles;
    }
    EXPECT_NEAR(lateral_force(length, diameter, drop, clearance, taper), std::abs(force), 0.01 * std::abs(force))
        << taper;
  }
}

TEST(LateralForce, NoTaperGivesMoreThanMerrittsMost) {
  const double most = largest_lateral_force(6e-3, 6.5e-3, 2e7);
  EXPECT_NEAR(most, 0.27 * 6e-3 * 6.5e-3 * 2e7, 0.01 * most);
  for (double ratio = 0.01; ratio < 100; ratio *= 1.1)
    EXPECT_LE(lateral_force(6e-3, 6.5e-3, 2e7, 1, ratio), most * 1.001) << ratio;
}

Diagnosis named(const char* fault, double severity, const Table& tuned) {
  Diagnosis d;
  d.fault = find_fault(fault);
  ParameterVector candidate = candidate_of(tuned);
  d.fault->apply(candidate.data(), severity);
  d.assessment.explanations.push_back({.fault = d.fault, .candidate = candidate});
  return d;
}

TEST(LateralForce, StandsBesideAFaultOfFrictionAndNoOther) {
  const Table tuned = shipped_table();
  RigFile rig = shipped_rig();
  EXPECT_FALSE(friction_beside_force(named("sticky_spool", 20, tuned), tuned, rig)) << "no length of a land";
  rig.facts["valve.land_length"] = 6e-3;
  const auto beside = friction_beside_force(named("sticky_spool", 20, tuned), tuned, rig);
  ASSERT_TRUE(beside);
  EXPECT_NEAR(beside->friction, 20 * candidate_of(tuned)[row::spool_friction], 1e-9);
  EXPECT_GT(beside->largest, 100);
  EXPECT_NEAR(beside->coefficient(), beside->friction / beside->largest, 1e-12);
  EXPECT_FALSE(friction_beside_force(named("clogged_filter", 0.5, tuned), tuned, rig));
  EXPECT_FALSE(friction_beside_force(Diagnosis{}, tuned, rig));
}

}  // namespace
}  // namespace servodx
