// Distances of faults from health and from rivals, on effects that are vectors of a few numbers.
#include "plan/information.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "faults/registry.h"
#include "plan/lanes.h"

namespace servodx {
namespace {

// Lanes: 0 a tolerance, 1 a fault, 2 and 3 a rival at two severities.
LaneSet some_lanes() {
  LaneSet set;
  set.lanes.resize(4);
  set.health = {0};
  RivalLanes rival;
  rival.fault = find_fault("sticky_spool");
  rival.sides = {{{2.5, 20}, {2, 3}}};
  rival.beside = {0};
  set.rivals = {rival};
  set.targets = {{find_fault("clogged_filter"), 0.6, 1}};
  return set;
}

Eigen::MatrixXd gram(const Eigen::MatrixXd& effects) { return effects.transpose() * effects; }

TEST(Information, WhatNothingElseDoesStandsOutWhole) {
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(4, 4);
  effects(0, 0) = 5, effects(1, 1) = 3, effects(2, 2) = 1, effects(2, 3) = 2;
  const Eigen::MatrixXd g = gram(effects);
  const LaneSet set = some_lanes();
  const Information information(g, set);
  EXPECT_NEAR(information.from_health(1), 9.0, 1e-12);
  EXPECT_NEAR(information.from_rival(set.targets[0], 0), 9.0 + 1.0, 1e-12) << "the mildest rival does least";
}

// An effect like a tolerance's is worth what lies beyond its prior: (a / sd)^2 by sd / (1 + sd^2).
TEST(Information, WhatAToleranceDoesTooIsTakenOut) {
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(4, 4);
  effects(0, 0) = 2, effects(0, 1) = 6, effects(1, 1) = 1;
  const Eigen::MatrixXd g = gram(effects);
  const LaneSet set = some_lanes();
  EXPECT_NEAR(Information(g, set).from_health(1), 36.0 / (1 + 4) + 1, 1e-12);
}

TEST(Information, ARivalStandsAtTheSeverityThatComesNearest) {
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(4, 4);
  effects(1, 1) = 3, effects(2, 1) = 0.5;  // the fault
  effects(1, 2) = 1, effects(1, 3) = 5;    // the rival, from mild to severe: 3 lies between
  const Eigen::MatrixXd g = gram(effects);
  const LaneSet set = some_lanes();
  EXPECT_NEAR(Information(g, set).from_rival(set.targets[0], 0), 0.25, 1e-12);
}

TEST(Information, ARowIsKnownBetterByWhatOnlyItDoes) {
  LaneSet set = some_lanes();
  set.rows = {{"row", "m", 2.0, 1}};
  set.beside_rows = {0, 1};
  Eigen::MatrixXd effects = Eigen::MatrixXd::Zero(4, 4);
  effects(1, 1) = 3;
  Eigen::MatrixXd g = gram(effects);
  EXPECT_NEAR(Information(g, set).left_of(set.rows[0]), std::sqrt(1 / 10.0), 1e-12);
  effects(1, 0) = 30;  // now a tolerance does the same, and more
  g = gram(effects);
  EXPECT_GT(Information(g, set).left_of(set.rows[0]), 0.9);
}

}  // namespace
}  // namespace servodx
