// Our closed form: exact for its own edges, near HF on valves and grids it was not read from. What it costs `servodx
// map` prints.
#include "valve_maps/bridge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "servodx/map_points.h"
#include "servodx/valve_numbers.h"
#include "support.h"
#include "valve_maps/compare_maps.h"
#include "valve_maps/high_fidelity.h"

namespace servodx::valve_maps {
namespace {

const MapError& of(const std::vector<MapError>& all, const std::string& name) {
  for (const MapError& e : all)
    if (e.name == name) return e;
  ADD_FAILURE() << name;
  return all.front();
}

// The bridge's own edges, solved by halving.
double solved(const Bridge& b, double x, double q, double supply) {
  const auto flow = [&](double opening, double dp) {
    const double open = std::max(opening, 0.0), height2 = b.null_height * b.null_height;
    const double narrow = height2 / (height2 + open * open);
    const double r = (b.laminar + b.laminar_cover * std::max(-opening, 0.0)) * narrow, k = b.turbulent * narrow;
    return 2 * dp / (r + std::sqrt(r * r + 4 * k * std::fabs(dp)));
  };
  double low = -1e12, high = 1e12;  // above return, of the port that the load draws from
  for (int i = 0; i < 200; ++i) {
    const double p = 0.5 * (low + high);
    (flow(x - b.lap, supply - p) - flow(-x - b.lap, p) > q ? low : high) = p;
  }
  return std::max(low, -b.suction) - (supply - low);
}

TEST(Bridge, ClosedFormSolvesItsOwnEdges) {
  for (double lap : {0.0, 5e-6}) {
    ValveGeometry g = flight_valve();
    g.lap_pa = g.lap_pb = g.lap_at = g.lap_bt = lap;
    HighFidelity hf(g);
    const ValveNumbers v = hf.measure(test_supply);
    const Bridge bridge(v);
    for (double x : {-3e-4, -2e-5, -4e-6, 0.0, 1e-6, 8e-6, 1e-4})
      for (double q : {0.0, 1e-8, 1e-6, 5e-6, 5e-5})
        for (double supply : {test_supply, 1e5}) {
          const double expected = solved(bridge, x, q, supply);
          EXPECT_NEAR(bridge(x, q, supply), expected, 1e-6 * (supply + std::fabs(expected))) << x << " " << q;
          EXPECT_NEAR(bridge(-x, -q, supply), -expected, 1e-6 * (supply + std::fabs(expected))) << x << " " << q;
        }
  }
}

TEST(Bridge, ReturnsTheNumbersItWasMadeFrom) {
  ValveNumbers v = HighFidelity(flight_valve()).measure(test_supply);
  v.lap = 0;
  const Bridge bridge(v);
  EXPECT_NEAR(bridge(0.4 * v.straight_travel(), 0, v.supply), 0.4 * v.supply, 1e-6 * v.supply);
  const double far = 1e3 * bridge.null_height;  // no load: the flow gain
  EXPECT_NEAR(bridge(far, v.flow_gain * far, v.supply), 0.0, 2e-3 * v.supply);
}

// Valves other than the one the form was written for; each grid holds none of the points that gave the numbers.
TEST(Bridge, IsNearHfInEveryRegionOnOtherValves) {
  struct Case {
    const char* what;
    double clearance, lap, uneven, viscosity;
  };
  for (const Case& c : {Case{"as new", 3.5e-6, 0, 0, 0.0119}, Case{"worn", 12e-6, 0, 0, 0.0119},
                        Case{"cold", 3.5e-6, 0, 0, 0.08}, Case{"overlap", 3e-6, 6e-6, 0, 0.0119},
                        Case{"uneven laps", 3.5e-6, 0, 3e-6, 0.0119}, Case{"hot", 3.5e-6, 0, 0, 0.006}}) {
    ValveGeometry g = flight_valve();
    g.radial_clearance = c.clearance;
    g.lap_pa = g.lap_bt = c.lap + c.uneven;
    g.lap_pb = g.lap_at = c.lap - c.uneven;
    g.dynamic_viscosity = c.viscosity;
    HighFidelity hf(g);
    const ValveNumbers v = hf.measure(test_supply);
    const auto errors = compare(v, hf, {.costs = false});
    const MapError &ours = of(errors, "bridge"), &c5 = of(errors, "C5");
    for (std::size_t r = 0; r < ours.regions.size(); ++r) {
      EXPECT_GT(ours.regions[r].points, 50) << c.what << " " << region_names[r];
      EXPECT_LT(ours.regions[r].rms, 0.5 * c5.regions[r].rms) << c.what << " " << region_names[r];
    }
    EXPECT_LT(ours.regions[static_cast<std::size_t>(Region::water_hammer)].rms, 0.2) << c.what;
    // Cold oil is laminar in open edges too, in proportions that no number of the black box tells.
    EXPECT_LT(ours.regions[static_cast<std::size_t>(Region::open)].rms, c.viscosity > 0.05 ? 0.2 : 0.1) << c.what;
    EXPECT_LT(ours.regions[static_cast<std::size_t>(Region::linear)].rms, 0.15) << c.what;
    for (const RegionError& r : of(errors, "HF").regions) EXPECT_EQ(r.largest, 0.0);
  }
}

}  // namespace
}  // namespace servodx::valve_maps
