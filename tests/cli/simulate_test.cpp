// `servodx simulate`: what it writes is a log again, with the columns of the log it was given.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "program.h"
#include "servodx/rig.h"
#include "signals/log.h"

namespace servodx {
namespace {

struct Bench : Desk {
  Bench() {
    write("log.csv", small_log());
    write("table.csv", shipped_table());
  }
};

const std::string simulate = "simulate log.csv --params table.csv -o sim.csv";

TEST(Simulate, WritesTheLogsMeasuredSignalsInTheLogsUnits) {
  const Bench bench;
  const Ended ended = bench.run(simulate);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("sim.csv"), std::string::npos) << ended.out;
  const Log log = read_log(bench / "log.csv");
  const Log sim = read_log(bench / "sim.csv", {}, {.require_drive = false});
  EXPECT_EQ(sim.time, log.time);
  for (Signal s : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b}) {
    ASSERT_TRUE(sim.has(s)) << info(s).name;
    EXPECT_EQ(sim.channels[index(s)].unit, log.channels[index(s)].unit) << info(s).name;
    for (double v : sim[s]) ASSERT_TRUE(std::isfinite(v)) << info(s).name;
  }
  // Inputs are no result.
  EXPECT_FALSE(sim.has(Signal::supply_pressure));
  EXPECT_FALSE(sim.has(Signal::command));
  // 4 mA of 20 move the spool by a fifth of its half millimetre.
  EXPECT_NEAR(sim[Signal::spool_position][140], 1e-4, 1e-5);
}

// The rig file's names, volts, gains and offsets come back: the result stands beside the log column by column.
TEST(Simulate, WritesTheLogsOwnNamesUnitsAndGains) {
  const Bench bench;
  ASSERT_EQ(bench.run(simulate).code, 0);
  const ReadOptions any{.require_drive = false};
  const Log canonical = read_log(bench / "sim.csv", {}, any);
  bench.write(
      "rig.toml",
      "[columns]\n\"Pos fb\" = { signal = \"piston_position\", unit = \"V\", gain = \"20 mm/V\", offset = \"-100 "
      "mm\" }\n\"Spool\" = { signal = \"spool_position\", gain = \"-1\" }\n\"pB\" = { signal = \"pressure_b\" }\n");
  const Log log = read_log(bench / "log.csv");
  std::string text = "time [ms],command [mA],Spool [um],pB [bar],Pos fb [V],pressure_a [MPa],supply_pressure [bar]\n";
  for (std::size_t k = 0; k < log.samples(); ++k)
    text += fmt::format("{},{},{},{},{},{},{}\n", log.time[k] * 1e3, log[Signal::command][k] * 1e3,
                        -log[Signal::spool_position][k] * 1e6, log[Signal::pressure_b][k] * 1e-5,
                        (log[Signal::piston_position][k] + 0.1) / 0.02, log[Signal::pressure_a][k] * 1e-6, 207);
  bench.write("own.csv", text);
  const Ended ended = bench.run("simulate own.csv --params table.csv --rig rig.toml -o own_sim.csv");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string written = bytes_of(bench / "own_sim.csv"), header = written.substr(0, written.find('\n'));
  for (const char* column : {"time [ms]", "Spool [um]", "pB [bar]", "Pos fb [V]", "pressure_a [MPa]"})
    EXPECT_NE(header.find(column), std::string::npos) << column << " is not in " << header;
  const Log own = read_log(bench / "own_sim.csv", read_rig_file(bench / "rig.toml"), any);
  for (Signal s : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
    for (std::size_t k = 0; k < own.samples(); ++k)
      ASSERT_NEAR(own[s][k], canonical[s][k], 1e-6 * (1e-6 + std::abs(canonical[s][k]))) << info(s).name << " " << k;
}

TEST(Simulate, TheNumberOfThreadsChangesNoByte) {
  const Bench bench;
  ASSERT_EQ(bench.run("simulate log.csv --params table.csv -o one.csv --threads 1").code, 0);
  ASSERT_EQ(bench.run("simulate log.csv --params table.csv -o two.csv --threads 2").code, 0);
  EXPECT_FALSE(bytes_of(bench / "one.csv").empty());
  EXPECT_EQ(bytes_of(bench / "one.csv"), bytes_of(bench / "two.csv"));
}

TEST(Simulate, TheReferenceStepMovesTheResultLittle) {
  const Bench bench;
  ASSERT_EQ(bench.run(simulate).code, 0);
  ASSERT_EQ(bench.run("simulate log.csv --params table.csv -o reference.csv --reference").code, 0);
  const ReadOptions any{.require_drive = false};
  const Log a = read_log(bench / "sim.csv", {}, any), b = read_log(bench / "reference.csv", {}, any);
  double worst = 0;
  for (std::size_t k = 0; k < a.samples(); ++k)
    worst = std::max(worst, std::abs(a[Signal::spool_position][k] - b[Signal::spool_position][k]));
  EXPECT_GT(worst, 0.0);
  EXPECT_LT(worst, 5e-6);  // [m] 1 % of the stroke
}

TEST(Simulate, AnUnwantedOutputFileIsReplacedWhole) {
  const Bench bench;
  bench.write("sim.csv", std::string(1'000'000, 'x'));
  ASSERT_EQ(bench.run(simulate).code, 0);
  EXPECT_FALSE(bytes_of(bench / "sim.csv").ends_with("x"));
}

TEST(Simulate, JsonOnStandardOutputStandsAlone) {
  const Bench bench;
  const Ended ended = bench.run(simulate + " --json - --seed 7");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto json = nlohmann::json::parse(ended.out);
  for (const char* key : {"tool", "version", "command", "seed", "settings", "inputs", "seconds", "simulations",
                          "failed_simulations", "notes"})
    EXPECT_TRUE(json.contains(key)) << key;
  EXPECT_EQ(json["tool"], "servodx");
  EXPECT_EQ(json["command"], "simulate");
  EXPECT_EQ(json["seed"], 7);
  EXPECT_EQ(json["simulations"], 1);
  std::set<std::string> paths;
  for (const auto& input : json["inputs"]) {
    paths.insert(input["path"]);
    EXPECT_EQ(input["sha256"].get<std::string>().size(), 64u);
  }
  EXPECT_EQ(paths, (std::set<std::string>{"log.csv", "table.csv"}));
}

TEST(Simulate, JsonInAFileStandsBesideTheText) {
  const Bench bench;
  const Ended ended = bench.run(simulate + " --json result.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_FALSE(ended.out.empty());
  EXPECT_EQ(nlohmann::json::parse(bytes_of(bench / "result.json"))["command"], "simulate");
}

}  // namespace
}  // namespace servodx
