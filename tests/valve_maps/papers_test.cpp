// What the review of simplified servovalve models says of each, its Fig. 3 and section 4.
#include <gtest/gtest.h>

#include <cmath>

#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"
#include "support.h"
#include "valve_maps/compare_maps.h"
#include "valve_maps/high_fidelity.h"
#include "valve_maps/linear.h"
#include "valve_maps/model_a.h"
#include "valve_maps/model_c1.h"
#include "valve_maps/model_c2.h"
#include "valve_maps/model_c3.h"
#include "valve_maps/model_c5.h"
#include "valve_maps/papers_valve.h"
#include "valve_maps/registry.h"

namespace servodx::valve_maps {
namespace {

const ValveNumbers v = papers_numbers();
const double share = v.leak_share();                                // 0.2
const double saturating = 3.0 * v.flow_gain * v.saturation_travel;  // [m3/s] saturates the pressure at any small travel

TEST(Papers, LinearFollowsItsTwoGains) {
  const Linear linear(v);
  EXPECT_DOUBLE_EQ(linear(1e-5, 0, v.supply), v.null_slope * 1e-5);
  EXPECT_NEAR(linear(1e-5, v.flow_gain * 1e-5, v.supply), 0.0, 1e-6 * v.supply);
}

TEST(Papers, LinearAndADoNotSaturate) {
  EXPECT_GT(Linear(v)(10 * v.saturation_travel, 0, v.supply), 8 * v.supply);
  EXPECT_GT(ModelA(v)(10 * v.saturation_travel, 0, v.supply), 8 * v.supply);
}

// Section 2: G_P is read at zero flow. Leakage is in what is read, so each formula that divides by it must give it
// back.
TEST(Papers, EveryModelMeetsTheSlopeAtNullThatWasRead) {
  HighFidelity hf(flight_valve());
  for (const ValveNumbers& numbers : {hf.measure(test_supply), papers_numbers()}) {
    const double x = 1e-3 * numbers.saturation_travel, read = numbers.null_slope * x;
    for (const char* name : {"linear", "A", "C1", "C2", "C3", "C5"}) {
      const Map map = find_map(name)->make(numbers, hf);
      EXPECT_NEAR(map(x, 0, numbers.supply), read, 1e-9 * read) << name;
      // The flow that the line at null takes back to no load pressure.
      EXPECT_NEAR(map(x, numbers.flow_gain * x, numbers.supply), 0.0, 1e-9 * read) << name;
    }
  }
}

TEST(Papers, WithoutLeakageTheSlopeReadIsTheGain) {
  ValveNumbers dry = papers_numbers();
  dry.leakage = 0;
  dry.meet_slope();
  EXPECT_DOUBLE_EQ(dry.pressure_gain, dry.null_slope);
  EXPECT_DOUBLE_EQ(dry.saturation_travel, dry.straight_travel());
  EXPECT_DOUBLE_EQ(dry.leak_share(), 0.0);
  const HighFidelity none(flight_valve());
  for (const char* name : {"A", "C1", "C2", "C3", "C5"})
    EXPECT_DOUBLE_EQ(find_map(name)->make(dry, none)(0.5 * dry.saturation_travel, 0, dry.supply), 0.5 * dry.supply)
        << name;
}

// Merritt sec. 5-3: leakage alone bounds the slope to G_Q / C_LK. A slope read at that bound is met all the same.
TEST(Papers, ASlopeAtTheBoundOfLeakageIsMet) {
  ValveNumbers bound = papers_numbers();
  bound.leakage = 1.2 * bound.flow_gain / bound.null_slope;
  bound.meet_slope();
  const double x = 1e-3 * bound.saturation_travel;
  EXPECT_NEAR(ModelC5(bound)(x, 0, bound.supply), bound.null_slope * x, 1e-9 * bound.supply);
}

// Section 4: maps at 20 MPa, G_PQ C_LK = 0.2, here on a HF that reads as much.
TEST(Papers, Section4TheSecondExampleReadsThePapersNumbers) {
  HighFidelity hf(overlapped_to(flight_valve(), papers_leak_share, papers_supply));
  const ValveNumbers read = hf.measure(papers_supply);
  EXPECT_NEAR(read.leak_share(), papers_leak_share, 1e-6);
  EXPECT_NEAR(ModelC5(read)(read.saturation_travel, 0, papers_supply) / papers_supply, 1 / 1.2, 1e-6);
  EXPECT_NEAR(ModelC1(read)(1, 0, papers_supply) / papers_supply, 1 / 1.2, 1e-6);
  EXPECT_GT(read.lap, 2 * flight_valve().radial_clearance);
}

// Section 2: linear is "close to the null position", water hammer is of the closed valve.
TEST(Papers, Section2NamesTheRegions) {
  const double p = v.supply, near = 0.9 * v.straight_travel(), far = 1.1 * v.straight_travel();
  EXPECT_EQ(region_of(0.5 * p, near, p, v), Region::linear);
  EXPECT_EQ(region_of(0.95 * p, near, p, v), Region::saturated);
  EXPECT_EQ(region_of(0.95 * p, far, p, v), Region::saturated);
  EXPECT_EQ(region_of(-1.5 * p, near, p, v), Region::water_hammer);
  EXPECT_EQ(region_of(0.5 * p, far, p, v), Region::open);
  EXPECT_EQ(region_of(-1.5 * p, far, p, v), Region::driven);
}

TEST(Papers, C1UnderestimatesTheLargestPressure) {
  const ModelC1 c1(v);
  double largest = 0;
  for (double x = -1e-3; x <= 1e-3; x += 1e-5) largest = std::max(largest, std::fabs(c1(x, 0, v.supply)));
  EXPECT_DOUBLE_EQ(largest, v.supply / (1 + share));
}

TEST(Papers, C2ReachesTheSupply) {
  EXPECT_DOUBLE_EQ(ModelC2(v)(2 * v.saturation_travel, 0, v.supply), v.supply);
  EXPECT_DOUBLE_EQ(ModelC2(v)(-2 * v.saturation_travel, 0, v.supply), -v.supply);
}

TEST(Papers, C5TendsToTheSupplyAndNeverReachesIt) {
  const ModelC5 c5(v);
  EXPECT_NEAR(c5(v.saturation_travel, 0, v.supply) / v.supply, 0.83, 0.005);
  double before = 0;
  for (double x = v.saturation_travel; x < 1.0; x *= 2) {
    const double p = c5(x, 0, v.supply);
    EXPECT_GT(p, before);
    EXPECT_LT(p, v.supply);
    before = p;
  }
  EXPECT_GT(before, 0.9999 * v.supply);
}

// Up to x_SS the two are one formula; beyond, C3's saturated numerator leaves P_SR |xS| / (|xS| + ...), which C5 is
// too.
TEST(Papers, C3EqualsC5WithoutFlow) {
  for (double x = -5e-4; x <= 5e-4; x += 1e-5)
    EXPECT_NEAR(ModelC3(v)(x, 0, v.supply), ModelC5(v)(x, 0, v.supply), 1e-9 * v.supply) << x;
}

TEST(Papers, C3DipsAroundTheClosedValveWhereTheFlowSaturatesIt) {
  const ModelC3 c3(v);
  const double at_null = c3(0, -saturating, v.supply);
  EXPECT_DOUBLE_EQ(at_null, v.supply / (1 + share));
  // Not monotone in xS: it falls from the far closed side to the null and rises again.
  EXPECT_GT(c3(-1.9 * v.saturation_travel, -saturating, v.supply), 1.02 * at_null);
  EXPECT_GT(c3(3 * v.saturation_travel, -saturating, v.supply), 1.02 * at_null);
}

TEST(Papers, NoModelOfThePaperThatSaturatesExceedsTheSupply) {
  const HighFidelity none(flight_valve());
  for (const char* name : {"C1", "C2", "C3", "C5"}) {
    const Map map = find_map(name)->make(v, none);
    for (double supply : {v.supply, 0.1 * v.supply, v.vapour_pressure})
      for (const MapPoint& p : grid(map, 1e-3, 41, 10 * saturating, 21, supply))
        EXPECT_LE(std::fabs(p.load_pressure), supply * (1 + 1e-12)) << name;
  }
}

TEST(Papers, OnlyHfAndOursShowTheWaterHammer) {
  HighFidelity hf(flight_valve());
  const ValveNumbers measured = hf.measure(test_supply);
  const double hammer = 2 * measured.flow_gain * measured.straight_travel();
  for (const char* name : {"HF", "bridge"}) {
    const Map map = find_map(name)->make(measured, hf);
    for (double supply : {test_supply, 0.3 * test_supply, measured.vapour_pressure}) {
      EXPECT_LT(map(0, hammer, supply), -1.5 * supply) << name;  // closed: the flow asked for drives it beyond
      EXPECT_GT(map(0, -hammer, supply), 1.5 * supply) << name;
    }
    // Open, with what the valve can pass: it obeys the supply.
    for (double x : {-4e-4, 4e-4})
      for (double q : {-0.5, 0.0, 0.5}) {
        const double passes = std::fabs(x) * measured.flow_gain;
        if (q * x < 0) continue;  // a load that drives the valve is another matter
        EXPECT_LE(std::fabs(map(x, q * passes, test_supply)), test_supply) << name;
      }
  }
}

TEST(Papers, MirroredTravelAndFlowMirrorThePressure) {
  HighFidelity hf(flight_valve());
  const ValveNumbers measured = hf.measure(test_supply);
  for (const MapInfo& info : map_list()) {
    const Map map = info.make(measured, hf);
    for (double x : {0.0, 2e-6, -3e-5, 4e-4})
      for (double q : {1e-7, -5e-6})
        EXPECT_NEAR(map(x, q, test_supply), -map(-x, -q, test_supply), 1e-6 * test_supply) << info.name;
  }
}

}  // namespace
}  // namespace servodx::valve_maps
