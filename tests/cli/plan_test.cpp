// plan and rig --command, as called: what is planned is what the rig plays.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "cli/program.h"
#include "fleet.h"

namespace servodx {
namespace {

// The numbers of a column of a CSV file, comments and head passed over.
std::vector<std::string> column(const std::string& text, std::size_t at) {
  std::vector<std::string> out;
  std::istringstream in(text);
  bool head = true;
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('#') || std::exchange(head, false)) continue;
    std::istringstream cells(line);
    std::string cell;
    for (std::size_t i = 0; i <= at; ++i) std::getline(cells, cell, ',');
    out.push_back(cell);
  }
  return out;
}

TEST(Plan, TheRigPlaysWhatWasPlanned) {
  const FleetDesk desk;
  const std::string call = "plan --params tuned.csv --rig rig.toml --faults sticky_spool --rounds 0 --seconds 0.5 ";
  const Ended planned = desk.run(call + "-o command.csv --quiet --json plan.json");
  ASSERT_EQ(planned.code, 0) << planned.err;
  const auto extremes = nlohmann::json::parse(bytes_of(desk.path / "plan.json"))["planned"]["extremes"];
  EXPECT_GE(extremes["pressure_low"], -1e5);  // oil holds no tension
  EXPECT_EQ(extremes["cavitates"], extremes["pressure_low"] == -1e5);
  const std::vector<std::string> asked = column(bytes_of(desk.path / "command.csv"), 1);
  EXPECT_EQ(asked.size(), 500u);
  EXPECT_GT(std::set<std::string>(asked.begin(), asked.end()).size(), 2u);
  const Ended played = desk.run("rig --rig-model " + std::string(SERVODX_SOURCE_DIR) +
                                "/params/rigs/borello2009.toml --command command.csv -o log.csv --quiet");
  ASSERT_EQ(played.code, 0) << played.err;
  const std::string log = bytes_of(desk.path / "log.csv");
  const std::vector<std::string> recorded = column(log, 1);
  ASSERT_EQ(recorded.size(), asked.size());
  // [mA] The rig records with its own resolution and noise.
  for (std::size_t i = 0; i < asked.size(); ++i) EXPECT_NEAR(std::stod(recorded[i]), std::stod(asked[i]), 0.1) << i;
}

TEST(Plan, WhatCannotBePlannedIsRefusedAndNothingWritten) {
  const FleetDesk desk;
  const auto before = desk.contents();
  for (const char* wrong : {"--faults stiky_spool", "--faults sticky_spool --seconds 0", "--rows no_such_row",
                            "--between sticky_spool", "--faults sticky_spool --between sticky_spool,clogged_filter"}) {
    const Ended ended = desk.run(std::string("plan --params tuned.csv --rig rig.toml -o command.csv --quiet ") + wrong);
    EXPECT_EQ(ended.code, 2) << wrong << ended.err;
    EXPECT_EQ(desk.contents(), before) << wrong;
  }
}

}  // namespace
}  // namespace servodx
