#include "valve_maps/high_fidelity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support.h"

namespace servodx::valve_maps {
namespace {

TEST(HighFidelity, NullIsWhereBlockedPortsHoldEqualPressures) {
  ValveGeometry g = flight_valve();
  g.lap_pa = 4e-6;
  g.lap_bt = -1e-6;
  HighFidelity hf(g);
  hf.measure(test_supply);
  EXPECT_NEAR(hf(0, 0, test_supply), 0.0, 1e-6 * test_supply);
  EXPECT_GT(std::fabs(hf.null()), 1e-7);
}

TEST(HighFidelity, LoadPressureRisesWithTravelAndFallsWithFlow) {
  const HighFidelity hf(flight_valve());
  for (double q : {-2e-6, 0.0, 2e-6})
    for (double x = -2e-5; x < 2e-5; x += 1e-6) {
      if (q == 0.0) {
        EXPECT_GT(hf(x + 1e-6, q, test_supply), hf(x, q, test_supply));
      }
      EXPECT_LT(hf(x, q + 1e-7, test_supply), hf(x, q, test_supply));
    }
}

TEST(HighFidelity, TheDrawnPortStaysAboveVapourPressure) {
  const ValveGeometry g = flight_valve();
  const HighFidelity hf(g);
  // Twice the flow beyond the hammer's onset: without the limit both ports would move alike.
  const double q = 1e-5, p = hf(0, q, test_supply);
  // The pressed port: all of q leaves it through the two closed edges, half of it each way.
  EXPECT_LT(p, -test_supply);
  ValveGeometry deep = g;
  deep.return_pressure = 100e6;  // no vapour within reach
  EXPECT_LT(HighFidelity(deep)(0, q, test_supply), p);
}

TEST(HighFidelity, WornClearanceLeaksWithItsCube) {
  ValveGeometry g = flight_valve();
  // Covered edges are annular slots; thick oil, so that their corners count for nothing.
  g.dynamic_viscosity = 0.2;
  g.lap_pa = g.lap_pb = g.lap_at = g.lap_bt = 50e-6;
  const double once = HighFidelity(g).leakage(0, test_supply);
  g.radial_clearance *= 2;
  EXPECT_NEAR(HighFidelity(g).leakage(0, test_supply) / once, 8.0, 0.5);
}

TEST(HighFidelity, NoLoadFlowGrowsWithTheRootOfTheSupplyWhereOpen) {
  const HighFidelity hf(flight_valve());
  EXPECT_NEAR(hf.no_load_flow(4e-4, test_supply) / hf.no_load_flow(4e-4, 0.25 * test_supply), 2.0, 0.02);
}

}  // namespace
}  // namespace servodx::valve_maps
