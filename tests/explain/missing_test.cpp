// A current, a force or a flow that is missing in the model, planted in logs that the model wrote at fine steps, comes
// out where it is, as large as it is, with the sensors that the log has; or these are said not to tell.
#include "explain/missing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "explain/missing_support.h"
#include "servodx/log.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

using Sensors = std::set<Signal>;
const Sensors piston = {Signal::piston_position}, spool_and_piston = {Signal::spool_position, Signal::piston_position},
              piston_and_pressures = {Signal::piston_position, Signal::pressure_a, Signal::pressure_b},
              all = {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b};
const std::vector<Sensors> subsets = {piston, spool_and_piston, piston_and_pressures, all};
const char* const log_name = "healthy/h12_mixed";

int likely(const MissingInputs& m) {
  int n = 0;
  for (const MissingInput& p : m.places) n += p.likely;
  return n;
}
// As large as planted, within the band as often as it says less a tenth.
void as_planted(const MissingInput& found, const std::vector<double>& truth) {
  EXPECT_TRUE(found.likely);
  EXPECT_NEAR(found.rms, rms(truth), 0.1 * rms(truth) + 0.2 * found.std_error);
  EXPECT_GT(held(found, truth), 0.8);
}

TEST(Missing, NothingWhereNothingIs) {
  for (const Sensors& sensors : subsets) {
    const Rehearsed r(log_name, {}, sensors, 1, 2);
    const MissingInputs m = r.missing();
    ASSERT_EQ(m.places.size(), 8u);
    EXPECT_EQ(likely(m), 0) << sensors.size();
    for (const MissingInput& p : m.places)
      for (std::size_t k = 0; k < p.value[0].size(); ++k) ASSERT_LE(std::abs(p.value[0][k]), 4 * p.error[0][k]);
  }
}

TEST(Missing, ForceOnThePistonIsFoundByAnySensors) {
  const Planted force = {.force = [](double t) { return 150 * std::sin(8 * t); }};
  for (const Sensors& sensors : subsets) {
    const Rehearsed r(log_name, force, sensors, 2, 2);
    const MissingInputs m = r.missing();
    as_planted(place(m, "piston_force", "force"), r.force);
    if (sensors.contains(Signal::pressure_a)) {
      EXPECT_EQ(likely(m), 1);
      EXPECT_LT(place(m, "piston_force", "force").std_error, 10) << "pressures beside the piston weigh a force";
    }
  }
}

TEST(Missing, CurrentIsFoundByAnySensorsAndNotToldFromAForceOnTheSpool) {
  const Planted current = {.current = [](double t) { return 2e-5 * std::sin(10 * t); }};
  for (const Sensors& sensors : subsets) {
    const Rehearsed r(log_name, current, sensors, 3, 2);
    const MissingInputs m = r.missing();
    as_planted(place(m, "drive", "current"), r.current);
    EXPECT_TRUE(place(m, "spool", "force").likely);
    if (sensors.contains(Signal::spool_position)) {
      EXPECT_EQ(likely(m), 2);
    }
  }
}

TEST(Missing, LeakIsAFlowAcrossThatFollowsTheLoadPressure) {
  const Planted leak = {.leak = 4e-12};
  for (const Sensors& sensors : {piston_and_pressures, all}) {
    const Rehearsed r(log_name, leak, sensors, 4, 2);
    const MissingInputs m = r.missing();
    const MissingInput& flow = place(m, "flow_a", "flow across");
    as_planted(flow, r.flow);
    EXPECT_EQ(m.places.front().quantity, "flow across");
    EXPECT_EQ(flow.variable, "load_pressure");
    EXPECT_GT(flow.share, 0.6);
  }
  // The piston alone does not tell a flow from what lets it in.
  const Rehearsed r(log_name, leak, piston, 4, 2);
  EXPECT_GT(likely(r.missing()), 1);
}

TEST(Missing, FrictionOfTheSealIsAForceThatFollowsTheDirection) {
  const Rehearsed r(log_name, {.seal = 100}, all, 5, 2);
  const MissingInputs m = r.missing();
  EXPECT_EQ(likely(m), 1);
  EXPECT_EQ(m.places.front().where, "piston_force");
  EXPECT_EQ(m.places.front().variable, "direction of the piston");
  EXPECT_GT(m.places.front().share, 0.6);
  EXPECT_NEAR(m.places.front().rms, rms(r.force), 0.1 * rms(r.force));
}

TEST(Missing, ValveOnATestStandIsNotLookedAt) {
  Rehearsed r(log_name, {}, all, 6, 2);
  r.rig.ports = Ports::blocked;
  r.log.channels[index(Signal::piston_position)].value.clear();
  EXPECT_TRUE(r.missing().places.empty());
}

}  // namespace
}  // namespace servodx
