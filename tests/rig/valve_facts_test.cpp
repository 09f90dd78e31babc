// The virtual valves beside what real ones and the paper's actuator do: params/rigs/valve_facts.csv holds the ranges
// and where each is read from.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "base/celsius.h"
#include "rig/facts.h"
#include "rig/fluid.h"
#include "rig/magnetics.h"
#include "rig/plant.h"
#include "rig/rig_model.h"
#include "rig/virtual_rig.h"
#include "rig_test_support.h"

namespace servodx::rig {
namespace {

namespace fs = std::filesystem;

const fs::path rigs = fs::path(SERVODX_SOURCE_DIR) / "params" / "rigs";

void expect_within(const RigModel& model, const std::vector<std::string>& left_out = {}) {
  const auto facts = measure_facts(model);
  for (const auto& limit : read_fact_limits((rigs / "valve_facts.csv").string(), model.name)) {
    if (std::find(left_out.begin(), left_out.end(), limit.name) != left_out.end()) continue;
    const auto fact = std::find_if(facts.begin(), facts.end(), [&](const Fact& f) { return f.name == limit.name; });
    ASSERT_NE(fact, facts.end()) << limit.name << " is measured by nobody";
    EXPECT_EQ(fact->unit, limit.unit) << limit.name;
    EXPECT_GE(fact->value, limit.low) << model.name << ' ' << limit.name;
    EXPECT_LE(fact->value, limit.high) << model.name << ' ' << limit.name;
  }
}

class ShippedRig : public ::testing::TestWithParam<std::string> {};

TEST_P(ShippedRig, HasFactsWithinTheRangeOfRealValves) { expect_within(read_rig_model((rigs / GetParam()).string())); }

INSTANTIATE_TEST_SUITE_P(ValveFacts, ShippedRig, ::testing::Values("borello2009.toml", "bench.toml", "jet_pipe.toml"),
                         [](const auto& test) { return std::filesystem::path(test.param).stem().string(); });

TEST(ValveFacts, OfAnotherValveOfTheTypeLieWithinTheRangeOfRealOnes) {
  // Speed and stall are the paper's actuator with its own valve.
  RigModel other = another_valve(flight_rig(), 5);
  set_value(other, "ports=free");
  expect_within(other, {"no_load_speed", "stall_force"});
}

TEST(ValveFacts, PilotPressureOfAHealthyFlapperValveIsBetweenHalfAndTwoThirdsOfSupply) {
  for (const double celsius : {-30.0, 0.0, 40.0, 70.0}) {
    const VirtualRig rig = settled({.temperature = celsius + zero_celsius});
    for (const Var p : {p_pilot_1, p_pilot_2}) {
      const double share = rig.state()[p] / rig.state()[p_supply];
      EXPECT_GT(share, 0.5) << celsius;
      EXPECT_LT(share, 2.0 / 3.0) << celsius;
    }
  }
}

TEST(ValveFacts, NoLoadSpeedIsAlikeBothWays) {
  for (const double sign : {1.0, -1.0}) {
    VirtualRig rig = settled({}, -0.1 * sign);
    hold(rig, sign * 0.020, 0.3);
    const double before = rig.piston_position();
    hold(rig, sign * 0.020, 0.2);
    EXPECT_NEAR((rig.piston_position() - before) / 0.2, sign * 0.300, 0.006);
  }
}

TEST(ValveFacts, LeakageAtNullIsUnderFourPercentOfRatedFlowAndPilotLeakageIsMostOfIt) {
  const VirtualRig rig = settled();
  const Flows flows = rig.flows();
  EXPECT_LT(flows.q_supply, 0.04 * 2.4e-4);
  EXPECT_GT(flows.q_filter, 0.5 * flows.q_supply);
}

TEST(TorqueMotor, TorqueIsTheFallOfMagneticEnergyWithAngle) {
  const Magnetics motor(flight_rig());
  for (const double flux : {-5e-6, 0.0, 3e-6}) {
    for (const double angle : {-3e-3, 0.0, 2e-3}) {
      const double d = 1e-6;
      const double fall = -(motor.energy(flux, angle + d) - motor.energy(flux, angle - d)) / (2.0 * d);
      EXPECT_NEAR(motor.at(0.0, flux, angle, 0.0).torque, fall, 1e-6 * (1e-2 + std::fabs(fall)));
    }
  }
}

TEST(TorqueMotor, TorqueFollowsFromTheMagnetsAndTheIronSaturates) {
  const RigModel& m = flight_rig();
  const double rated = m.driver_rated_current;
  EXPECT_NEAR(motor_torque(m, -rated, -1e-3), -motor_torque(m, rated, 1e-3), 1e-9);
  EXPECT_GT(motor_torque(m, rated, 1e-3), motor_torque(m, rated, 0.0));  // the magnetic spring pushes away from null
  RigModel weaker = m;
  weaker.motor_magnet_mmf *= 0.5;
  EXPECT_NEAR(motor_torque(weaker, rated, 0.0) / motor_torque(m, rated, 0.0), 0.5, 1e-6);
  EXPECT_LT(motor_torque(m, 4.0 * rated, 0.0), 3.6 * motor_torque(m, rated, 0.0));
}

}  // namespace
}  // namespace servodx::rig
