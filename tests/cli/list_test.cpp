// `servodx list`, --version and --help.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "program.h"

namespace servodx {
namespace {

std::set<std::string> names_in(const std::string& kind) {
  const Desk desk;
  const Ended ended = desk.run("list " + kind + " --json -");
  EXPECT_EQ(ended.code, 0) << ended.err;
  std::set<std::string> names;
  const auto json = nlohmann::json::parse(ended.out);
  for (const auto& item : json.at(kind)) names.insert(item.at("name"));
  return names;
}

TEST(List, EveryKindIsPrinted) {
  const Desk desk;
  for (const char* kind : {"faults", "effects", "params", "models", "signals", "excitations"}) {
    const Ended ended = desk.run(std::string("list ") + kind);
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_GE(std::count(ended.out.begin(), ended.out.end(), '\n'), 2) << ended.out;
    EXPECT_FALSE(names_in(kind).empty()) << kind;
  }
}

TEST(List, FaultsHaveTheContractsLabels) {
  const auto names = names_in("faults");
  for (const char* label : {"clogged_filter", "torque_motor_loss", "feedback_wire_backlash", "feedback_wire_lost",
                            "sticky_spool", "radial_clearance_wear", "null_shift"})
    EXPECT_TRUE(names.contains(label)) << label;
}

TEST(List, ThereAre41Parameters) { EXPECT_EQ(names_in("params").size(), 41u); }

TEST(List, ParametersOfARigSayWhereTheyComeFrom) {
  const Desk desk;
  desk.write("table.csv", shipped_table());
  desk.write("rig.toml", "[valve]\nspool_diameter = \"7 mm\"\n");
  const Ended ended = desk.run("list params --params table.csv --rig rig.toml --json -");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  for (const auto& row : json.at("params")) {
    EXPECT_FALSE(row.at("source").get<std::string>().empty()) << row;
    if (row.at("name") != "spool_diameter") continue;
    EXPECT_EQ(row.at("nominal"), 0.007);
    EXPECT_EQ(row.at("source"), "rig.toml: valve.spool_diameter");
  }
}

TEST(Program, TellsItsVersionAndHelps) {
  const Desk desk;
  const Ended version = desk.run("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_TRUE(version.out.starts_with("servodx ")) << version.out;
  EXPECT_TRUE(std::regex_match(version.out, std::regex("servodx \\d+\\.\\d+\\.\\d+ \\(commit [-\\w]+, \\w+\\)\n")))
      << version.out;
  const auto models = nlohmann::json::parse(desk.run("list models --json -").out);
  EXPECT_NE(version.out.find(models.at("models").at(0).at("kernel")), std::string::npos) << version.out;
  EXPECT_EQ(models.at("version").get<std::string>(), version.out.substr(8, version.out.find(' ', 8) - 8));
  for (const char* command : {"", "simulate ", "tune ", "baseline ", "diagnose ", "list ", "rig "}) {
    const Ended help = desk.run(std::string(command) + "--help");
    EXPECT_EQ(help.code, 0) << command;
    EXPECT_NE(help.out.find("Usage: servodx"), std::string::npos) << help.out;
  }
}

// The narrowest is everywhere; what no processor has is refused.
TEST(Program, RunsByTheInstructionSetThatIsAskedFor) {
  const Desk desk;
  const auto listed = [&](const std::string& environment) {
    return desk.run_with(environment, "list models --json -");
  };
  const auto kernel = [&](const std::string& environment) {
    const Ended ended = listed(environment);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return nlohmann::json::parse(ended.out).at("models").at(0).at("kernel").get<std::string>();
  };
  EXPECT_EQ(kernel("SERVODX_INSTRUCTION_SET=generic"), "generic");
  EXPECT_EQ(kernel("SERVODX_INSTRUCTION_SET="), kernel(""));
  const Ended none = listed("SERVODX_INSTRUCTION_SET=mmx");
  EXPECT_EQ(none.code, 2);
  EXPECT_TRUE(none.out.empty()) << none.out;
  EXPECT_NE(none.err.find("generic"), std::string::npos) << none.err;
}

TEST(Program, EveryCommandTakesTheCommonOptions) {
  const Desk desk;
  for (const char* command : {"simulate", "tune", "baseline", "diagnose", "list"}) {
    const std::string help = desk.run(std::string(command) + " --help").out;
    for (const char* option : {"--json", "--threads", "--seed", "--quiet", "--rig"})
      EXPECT_NE(help.find(option), std::string::npos) << command << " " << option;
  }
}

}  // namespace
}  // namespace servodx
