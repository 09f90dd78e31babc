// The least that a log would have shown of its fault, beside what was found.
#include "fleet/detectable_found.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "faults/registry.h"
#include "fleet/fleet_verdict.h"
#include "fleet/gather.h"
#include "servodx/fleet.h"

namespace servodx {
namespace {

using Bound = BoundCase::Bound;

FleetRow row(FleetVerdict verdict, const std::string& fault,
             const std::vector<std::pair<std::string, double>>& detectable) {
  FleetRow out;
  out.verdict = verdict, out.fault = fault;
  for (const auto& [label, least] : detectable) out.detectable.push_back({find_fault(label), least});
  return out;
}

// True size over the bound of a log that was called healthy.
double times_of(const std::string& label, double least, double truth) {
  const auto found = bound_case_of(row(FleetVerdict::healthy, "", {{label, least}}), label, truth);
  return found && found->bound == Bound::known ? found->times : NAN;
}

TEST(DetectableFound, SizesAreCountedFromHealthOnTheFaultsOwnScale) {
  EXPECT_NEAR(times_of("sticky_spool", 4, 16), 2, 1e-12);  // of a logarithmic scale, from 1
  EXPECT_NEAR(times_of("sticky_spool", 4, 2), 0.5, 1e-12);
  EXPECT_NEAR(times_of("torque_motor_loss", 0.8, 0.512), 3, 1e-12);
  EXPECT_NEAR(times_of("clogged_filter", 0.6, 0.75), 1.25, 1e-12);    // of a part lost, from 0
  EXPECT_NEAR(times_of("feedback_wire_lost", 0.8, 0.5), 2.5, 1e-12);  // of a part left, from 1
  EXPECT_NEAR(times_of("null_shift", 0.06, -0.12), 2, 1e-12);         // of either sign
  EXPECT_EQ(times_of("sticky_spool", 4.3, 4.3), 1);
  EXPECT_EQ(times_of("torque_motor_loss", 0.8, 0), HUGE_VAL);
}

TEST(DetectableFound, WhatIsBetterThanHealthIsNoFault) {
  const FleetRow log = row(FleetVerdict::healthy, "", {{"radial_clearance_wear", 2}, {"torque_motor_loss", 0.8}});
  EXPECT_FALSE(bound_case_of(log, "radial_clearance_wear", 0.5));
  EXPECT_FALSE(bound_case_of(log, "torque_motor_loss", 1.5));
  EXPECT_FALSE(bound_case_of(log, "radial_clearance_wear", -1));
}

TEST(DetectableFound, WhatNoBoundIsStatedOfIsSetApart) {
  const FleetRow of_filter = row(FleetVerdict::fault, "clogged_filter", {{"clogged_filter", NAN}});
  EXPECT_EQ(bound_case_of(of_filter, "clogged_filter", 0.5)->bound, Bound::none);
  EXPECT_EQ(bound_case_of(of_filter, "sticky_spool", 4)->bound, Bound::unstated);
  EXPECT_FALSE(bound_case_of(of_filter, "healthy", 0));
  EXPECT_FALSE(bound_case_of(of_filter, "a word of the user's own", 1));
  EXPECT_FALSE(bound_case_of(of_filter, "sticky_spool", -4)) << "no multiple of friction";
  EXPECT_TRUE(std::isnan(times_of("sticky_spool", 1, 1))) << "a bound at health says nothing";
}

TEST(DetectableFound, FoundIsAnyVerdictButHealthyAndNamedTheFaultsOwn) {
  const auto seen = [](FleetVerdict verdict, const std::string& fault) {
    const auto c = bound_case_of(row(verdict, fault, {{"sticky_spool", 4}}), "sticky_spool", 16);
    return std::pair(c->is_found, c->is_named);
  };
  EXPECT_EQ(seen(FleetVerdict::healthy, ""), std::pair(false, false));
  EXPECT_EQ(seen(FleetVerdict::unknown, ""), std::pair(true, false));
  EXPECT_EQ(seen(FleetVerdict::fault, "clogged_filter"), std::pair(true, false));
  EXPECT_EQ(seen(FleetVerdict::fault, "sticky_spool"), std::pair(true, true));
}

TEST(DetectableFound, CountsAreTheCountsByHand) {
  const std::string spool = "sticky_spool", filter = "clogged_filter";
  const DetectableFound found = detectable_found_of({{spool, Bound::known, 0.4, false, false},
                                                     {spool, Bound::known, 0.99, true, true},
                                                     {spool, Bound::known, 1, true, false},
                                                     {spool, Bound::known, 1.19, false, false},
                                                     {spool, Bound::known, 1.2, true, true},
                                                     {filter, Bound::known, 3, true, true},
                                                     {filter, Bound::known, HUGE_VAL, true, true},
                                                     {filter, Bound::none, 0, true, false},
                                                     {filter, Bound::none, 0, false, false},
                                                     {filter, Bound::unstated, 0, true, true}});
  const auto is = [](const FleetCounts::Seen& seen, long counted, long named, long of) {
    EXPECT_EQ(seen.found.counted, counted);
    EXPECT_EQ(seen.named.counted, named);
    EXPECT_EQ(seen.found.of, of);
    EXPECT_EQ(seen.named.of, of);
  };
  is(found.all.below, 1, 1, 2);
  is(found.all.beyond, 4, 3, 5);
  is(found.all.well_beyond, 3, 3, 3);
  is(found.all.unbounded, 1, 0, 2);
  is(found.faults.at(spool).beyond, 2, 1, 3);
  is(found.faults.at(filter).well_beyond, 2, 2, 2);
  is(found.faults.at(filter).below, 0, 0, 0);
  EXPECT_EQ(found.faults.size(), 2u);
  EXPECT_EQ(found.unstated, 1);
  EXPECT_EQ(found.median, 1.2);
  ASSERT_EQ(found.bands.size(), 6u);
  const long of[] = {1, 1, 2, 1, 1, 1};
  for (std::size_t i = 0; i < found.bands.size(); ++i) EXPECT_EQ(found.bands[i].seen.found.of, of[i]) << i;
  EXPECT_EQ(found.bands[2].from, 1);
  EXPECT_EQ(found.bands[2].to, 1.2);
  is(found.bands[2].seen, 1, 0, 2);
}

TEST(DetectableFound, OfNothingThereIsNothing) {
  const DetectableFound found = detectable_found_of({});
  EXPECT_TRUE(found.faults.empty());
  EXPECT_TRUE(std::isnan(found.median));
  EXPECT_EQ(found.all.beyond.found.of, 0);
}

}  // namespace
}  // namespace servodx
