// `servodx rig` as a user calls it.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "program.h"

namespace servodx {
namespace {

const std::string rig = "rig --rig-model '" + std::string(SERVODX_SOURCE_DIR) + "/params/rigs/borello2009.toml' ";

TEST(Rig, WritesALogAndTheTruthBesideIt) {
  const Desk desk;
  const Ended ended = desk.run(rig +
                               "--excitation mixed --duration 0.2 --valve 3 --fault sticky_spool=4@0.1..0.2 --set "
                               "actuator.leakage=1e-12 -o a.csv");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto truth = nlohmann::json::parse(bytes_of(desk / "a.truth.json"));
  EXPECT_EQ(truth.at("label"), "sticky_spool");
  EXPECT_EQ(truth.at("faults")[0].at("end"), 0.2);
  EXPECT_EQ(truth.at("changed")[0], "actuator.leakage=1e-12");
  EXPECT_TRUE(bytes_of(desk / "a.csv").find("spool_position [mm]") != std::string::npos);
}

TEST(Rig, TakesTheContractsLabelsAndWritesThemIntoTheTruth) {
  const Desk desk;
  for (const auto& [fault, label] : std::map<std::string, std::string>{{"corner_wear=medium", "corner_wear"},
                                                                       {"corner_radius_wear=medium", "corner_wear"},
                                                                       {"edge_wear=medium", "radial_clearance_wear"},
                                                                       {"driver_fault=medium@0.01", "driver_fault"},
                                                                       {"open_coil=0", "driver_fault"},
                                                                       {"supply_fault=mild", "supply_fault"},
                                                                       {"sensor_fault=0.9", "sensor_fault"}}) {
    const Ended ended = desk.run(rig + "--excitation mixed --duration 0.02 -o a.csv --fault " + fault);
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto truth = nlohmann::json::parse(bytes_of(desk / "a.truth.json"));
    EXPECT_EQ(truth.at("label"), label) << fault;
    EXPECT_EQ(truth.at("faults")[0].at("label"), label) << fault;
    if (fault == "edge_wear=medium") {
      EXPECT_EQ(truth.at("faults")[0].at("name"), "edge_wear") << "it is not alone to have that label";
    }
    EXPECT_EQ(truth.at("schema"), 1);
  }
}

TEST(Rig, WritesALabelledSetThatSimulateAccepts) {
  const Desk desk;
  const Ended ended = desk.run(rig + "--fleet 4 --out set --duration 0.2 --quiet");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string truth = bytes_of(desk / "set/valve_01/truth.csv");
  EXPECT_EQ(std::count(truth.begin(), truth.end(), '\n'), 5) << truth;
  desk.write("table.csv", shipped_table());
  const Ended simulated =
      desk.run("simulate set/valve_01/fault/f002_mixed.csv --rig set/valve_01/rig.toml --params table.csv -o sim.csv");
  EXPECT_EQ(simulated.code, 0) << simulated.err;
}

TEST(Rig, BadCallsAreRefusedAndNothingIsWritten) {
  const Desk desk;
  std::filesystem::create_directory(desk / "full");
  desk.write("full/notes.txt", "mine");
  const auto before = desk.contents();
  for (const auto& [call, told] : std::map<std::string, std::string>{
           {"--duration 0.1", "-o LOG.csv"},
           {"--fleet 3", "--out"},
           {"--fleet 3 --out full", "not empty"},
           {"--fleet 3 --out new -o a.csv", "--out DIR"},
           {"--fleet 3 --out new --fault sticky_spool=4", "leave out --fault"},
           {"--out new -o a.csv", "--fleet N"},
           {"--facts -o a.csv", "writes no log"},
           {"-o a.csv --set spool.weight=1", "unknown key"},
           {"-o a.csv --fault sticky_spool=4@x", "no time"},
           {"-o a.csv --fault sticky_spool=4@5..2", "does not end"},
           {"-o a.csv --duration 0.1 --fault sticky_spool=4@7", "the log ends at 0.1 s"}}) {
    const Ended ended = desk.run(rig + call);
    EXPECT_EQ(ended.code, 2) << call;
    EXPECT_NE(ended.err.find(told), std::string::npos) << call << ": " << ended.err;
  }
  EXPECT_EQ(desk.contents(), before);
}

TEST(Rig, TheTorqueMapRunsFromRatedToRatedCurrent) {
  const Desk desk;
  const Ended ended = desk.run(rig + "--torque-map map.csv");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string map = bytes_of(desk / "map.csv");
  EXPECT_TRUE(map.starts_with("current [mA],angle [mrad],torque [mN m]\n-20,"));
  EXPECT_EQ(std::count(map.begin(), map.end(), '\n'), 1 + 21 * 13);
}

}  // namespace
}  // namespace servodx
