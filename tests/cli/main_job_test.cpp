// tune, baseline, diagnose, one after another on short excerpts of the shipped logs: files, keys, codes, refusals.
// Whether the verdicts are right is tested elsewhere, on whole logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

std::string excerpt(const std::string& log, int rows) {
  std::istringstream in(bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / log));
  std::string text, line;
  for (int k = 0; k <= rows && std::getline(in, line);) {
    k += line.starts_with('#') ? 0 : 1;
    text += line + "\n";
  }
  return text;
}

void expect_keys(const Json& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys)
    EXPECT_TRUE(object.contains(key)) << key << " is not in " << object.dump().substr(0, 200);
}

void expect_header(const Json& json, const std::string& command) {
  expect_keys(
      json, {"tool", "version", "seed", "settings", "inputs", "seconds", "simulations", "failed_simulations", "notes"});
  EXPECT_EQ(json.at("command"), command);
  EXPECT_GT(json.at("simulations"), 0);
}

const std::string tune_call =
    "tune t1.csv t2.csv --params table.csv --rig rig.toml --generations 0 --effects none --quiet ";
const std::string baseline_call = "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --quiet ";
const std::string diagnose_call =
    "diagnose s1.csv b1.csv --params tuned.csv --rig rig.toml --baseline base.json --quiet ";

// Each stage runs once, and only for the tests that need it: under ctest every test is a process of its own.
class MainJob : public testing::Test {
 protected:
  static const Desk& desk() {
    static const std::unique_ptr<Desk> made = [] {
      auto desk = std::make_unique<Desk>();
      desk->write("table.csv", shipped_table());
      desk->write("rig.toml", bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / "rig.toml"));
      desk->write("t1.csv", excerpt("healthy/h12_mixed.csv", 700));
      desk->write("t2.csv", excerpt("healthy/h01_steps_large.csv", 700));
      desk->write("b1.csv", excerpt("healthy/h15_no_supply_signals.csv", 700));
      desk->write("b2.csv", excerpt("healthy/h04_multisine.csv", 700));
      desk->write("b3.csv", excerpt("healthy/h03_sine_2hz.csv", 700));
      desk->write("s1.csv", excerpt("fault/f02_clogged_filter_severe.csv", 700));
      return desk;
    }();
    return *made;
  }
  static const Ended& tuned() {
    static const Ended ended = desk().run(tune_call + "-o tuned.csv --json tuned.json");
    return ended;
  }
  static const Ended& based() {
    tuned();
    static const Ended ended = desk().run(baseline_call + "-o base.json --false-alarm 0.3");
    return ended;
  }
  static const Ended& diagnosed() {
    based();
    static const Ended ended = desk().run(diagnose_call + "--exit-code --json verdict.json");
    return ended;
  }

  static Json json(const std::string& name) { return Json::parse(bytes_of(desk() / name)); }
  static void expect_refused(const Ended& ended, const std::string& words) {
    EXPECT_EQ(ended.code, 2) << ended.err;
    EXPECT_NE(ended.err.find(words), std::string::npos) << "'" << words << "' is not in: " << ended.err;
  }
};

TEST_F(MainJob, TuneWritesTheTableAndTheContractsKeys) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  EXPECT_TRUE(tuned().out.starts_with("tuned ")) << tuned().out;
  const Json result = json("tuned.json");
  expect_header(result, "tune");
  expect_keys(result, {"channels", "parameters", "starts"});
  ASSERT_FALSE(result["channels"].empty());
  expect_keys(result["channels"][0], {"signal", "unit", "rms", "noise_rms", "heldout_rms"});
  ASSERT_FALSE(result["parameters"].empty());
  expect_keys(result["parameters"][0],
              {"id", "name", "nominal", "estimate", "std_error", "verdict", "confounded_with"});
  EXPECT_FALSE(result["starts"].empty());
  const Json inputs = result["inputs"];
  EXPECT_EQ(inputs.size(), 4u);  // rig, table, two logs
  EXPECT_EQ(desk().run("list params --params tuned.csv").code, 0);
}

TEST_F(MainJob, TuneDoesNotDependOnTheNumberOfThreads) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  ASSERT_EQ(desk().run(tune_call + "-o one.csv --threads 1").code, 0);
  EXPECT_EQ(bytes_of(desk() / "one.csv"), bytes_of(desk() / "tuned.csv"));
}

TEST_F(MainJob, AnInterruptedTuneWritesTheBestSoFar) {
  const TemporaryFolder streams;
  const std::string call =
      "cd '" + desk().path.string() + "' && timeout --preserve-status -s INT 0.5 '" + SERVODX_PROGRAM +
      "' tune t1.csv t2.csv --params table.csv --population 100 --generations 100000 -o part.csv >'" +
      (streams / "out") + "' 2>&1";
  const int status = std::system(call.c_str());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130) << bytes_of(streams / "out");
  EXPECT_EQ(desk().run("list params --params part.csv").code, 0);
  EXPECT_NE(bytes_of(streams / "out").find("interrupted"), std::string::npos);
}

TEST_F(MainJob, BaselineWritesTheContractsKeys) {
  ASSERT_EQ(based().code, 0) << based().err;
  EXPECT_TRUE(based().out.starts_with("threshold ")) << based().out;
  const Json result = json("base.json");
  expect_header(result, "baseline");
  expect_keys(result, {"threshold", "false_alarm", "scores"});
  expect_keys(result["false_alarm"], {"asked", "promised", "logs", "statement"});
  EXPECT_EQ(result["scores"].size(), 3u);
  EXPECT_EQ(result["false_alarm"]["asked"], 0.3);
}

TEST_F(MainJob, BaselineRefusesLogsThatTunedTheTable) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  expect_refused(desk().run("baseline t1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml -o other.json"), "t1.csv");
  EXPECT_FALSE(std::filesystem::exists(desk() / "other.json"));
}

TEST_F(MainJob, BaselineRefusesFewerThanThreeLogs) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  expect_refused(desk().run("baseline b1.csv b2.csv --params tuned.csv --rig rig.toml -o other.json"), "three");
}

TEST_F(MainJob, DiagnoseGivesEachLogAResultWithTheContractsKeys) {
  diagnosed();
  const Json result = json("verdict.json");
  expect_header(result, "diagnose");
  ASSERT_EQ(result["results"].size(), 2u);
  int worst = 0;
  for (const Json& r : result["results"]) {
    expect_keys(r, {"log", "verdict", "error", "threshold", "p_value", "fault", "probabilities", "ambiguous_with",
                    "separating_test", "severity", "onset_time", "parameters"});
    expect_keys(r["severity"], {"value", "lower", "upper", "unit"});
    const std::string verdict = r["verdict"];
    worst = std::max(worst, verdict == "fault" ? 10 : verdict == "unknown" ? 11 : 0);
  }
  EXPECT_EQ(result["results"][0]["log"], "s1.csv");
  EXPECT_EQ(diagnosed().code, worst) << diagnosed().err;
  EXPECT_TRUE(diagnosed().out.starts_with("s1.csv: ")) << diagnosed().out;

  // Without --exit-code a verdict is no failure, and the number of threads changes nothing.
  const Ended ended = desk().run(diagnose_call + "--json - --threads 1");
  EXPECT_EQ(ended.code, 0) << ended.err;
  Json again = Json::parse(ended.out), before = json("verdict.json");
  again.erase("seconds"), before.erase("seconds");
  EXPECT_EQ(again, before);
}

TEST_F(MainJob, ABaselineThatDoesNotServeIsRefused) {
  ASSERT_EQ(based().code, 0) << based().err;
  desk().write("copy.csv", bytes_of(desk() / "tuned.csv") + "\n");
  expect_refused(desk().run("diagnose s1.csv --params copy.csv --rig rig.toml --baseline base.json"),
                 "base.json: column 'tuned_sha256': was made with another table than copy.csv");
  desk().write("cut.json", bytes_of(desk() / "base.json").substr(0, 300));
  expect_refused(desk().run("diagnose s1.csv --params tuned.csv --rig rig.toml --baseline cut.json"), "is not JSON");
}

}  // namespace
}  // namespace servodx
