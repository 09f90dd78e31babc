// tune, baseline, diagnose, one after another on short excerpts of the shipped logs: files, keys, codes, refusals.
// Whether the verdicts are right is tested elsewhere, on whole logs.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "program.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

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

// The table is tuned once, and only for the tests that need it: under ctest every test is a process of its own.
class MainJob : public testing::Test {
 protected:
  static const Desk& desk() {
    static const std::unique_ptr<Desk> made = [] {
      auto desk = std::make_unique<Desk>();
      write_rig_and_baseline_logs(*desk);
      desk->write("t1.csv", excerpt("healthy/h12_mixed.csv", 700));
      desk->write("t2.csv", excerpt("healthy/h01_steps_large.csv", 700));
      desk->write("s1.csv", excerpt("fault/f02_clogged_filter_severe.csv", 300));
      return desk;
    }();
    return *made;
  }
  static const Ended& tuned() {
    static const Ended ended = desk().run(tune_call + "-o tuned.csv --json tuned.json");
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

  // The number of threads changes no bit.
  ASSERT_EQ(desk().run(tune_call + "-o one.csv --threads 1").code, 0);
  EXPECT_EQ(bytes_of(desk() / "one.csv"), bytes_of(desk() / "tuned.csv"));
}

TEST_F(MainJob, APriorAskedForHoldsARowToTheTablesNominal) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  const auto moved = [](const Json& result) {
    for (const Json& p : result["parameters"])
      if (p["name"] == "port_width") return std::abs(p["estimate"].get<double>() / p["nominal"].get<double>() - 1);
    return 0.0;
  };
  ASSERT_EQ(desk().run(tune_call + "-o held.csv --json held.json --prior port_width=1e-7").code, 0);
  EXPECT_LT(moved(json("held.json")), 1e-3);
  EXPECT_GT(moved(json("tuned.json")), 1e-2);
}

// Begins a search without end and sends it `signal` once it has opened its checkpoint, however long that takes.
Ended stopped_search(const Desk& desk, const std::string& signal, const std::string& out) {
  desk.write("search", "cd '" + desk.path.string() + "'\nset -m\n'" + SERVODX_PROGRAM +
                           "' tune t1.csv t2.csv --params table.csv --population 100 --generations 100000 --checkpoint "
                           "kept -o " +
                           out + " >words 2>&1 &\nwhile kill -0 $! && ! test -s kept; do sleep 0.05; done 2>alive\n" +
                           "kill -" + signal + " $!\nwait $!\n");
  const int status = std::system(("bash '" + (desk / "search") + "'").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(desk / "words"), ""};
}

TEST_F(MainJob, ATuneThatIsToldToEndWritesTheBestSoFar) {
  for (const auto& [signal, code] : {std::pair("INT", 130), std::pair("TERM", 143)}) {
    const std::string out = std::string("part_") + signal + ".csv";
    std::filesystem::remove(desk() / "kept");
    const Ended ended = stopped_search(desk(), signal, out);
    EXPECT_EQ(ended.code, code) << ended.out;
    EXPECT_NE(ended.out.find("interrupted"), std::string::npos) << ended.out;
    EXPECT_EQ(desk().run("list params --params " + out).code, 0);
  }
}

// A longer search begins with what a shorter one has kept.
TEST_F(MainJob, AResumedSearchEndsAsTheWholeOne) {
  const std::string call =
      "tune t1.csv t2.csv --params table.csv --rig rig.toml --effects none --rounds 1 --population 60 ";
  ASSERT_EQ(desk().run(call + "--generations 11 -o whole.csv --quiet").code, 0);
  ASSERT_EQ(desk().run(call + "--generations 7 --checkpoint cut.search -o cut.csv --quiet").code, 0);
  const Ended longer = desk().run(call + "--generations 11 --checkpoint cut.search --resume --threads 1 -o cut.csv");
  ASSERT_EQ(longer.code, 0) << longer.err;
  EXPECT_NE(longer.err.find("2 finished stages were taken from it"), std::string::npos) << longer.err;
  EXPECT_EQ(bytes_of(desk() / "cut.csv"), bytes_of(desk() / "whole.csv"));
}

TEST_F(MainJob, BaselineRefusesLogsThatTunedTheTableAndTooFewLogs) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  expect_refused(desk().run("baseline t1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml -o base.json --dry-run"),
                 "this log tuned");
  expect_refused(desk().run("baseline t1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml -o base.json"),
                 "t1.csv: ");
  expect_refused(desk().run("baseline b1.csv b2.csv --params tuned.csv --rig rig.toml -o base.json"), "at least 3");
  EXPECT_FALSE(std::filesystem::exists(desk() / "base.json"));
}

// Found by the table's manifest, where they are as they were; else the baseline stands alone.
TEST_F(MainJob, BaselineLooksAtTheLogsThatTunedAsAtOthers) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  const std::string call = "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml -o with.json ";
  const auto others = [&](const std::string& more) {
    const Ended ended = desk().run(call + more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const Json made = json("with.json");
    std::vector<std::string> out;
    for (const Json& s : made.at("others")) out.push_back(s.at("log"));
    return out;
  };
  EXPECT_EQ(others(""), (std::vector<std::string>{"t1.csv", "t2.csv"}));
  const Json made = json("with.json");
  EXPECT_EQ(made.at("scores").size(), 3u);
  EXPECT_EQ(made.at("explain").at("logs").size(), 3u) << "three tests show how sizes scatter from test to test";
  EXPECT_EQ(made.at("false_alarm").at("logs"), 3) << "they promise nothing";
  EXPECT_EQ(others("--alone"), std::vector<std::string>{});
  EXPECT_EQ(json("with.json").at("threshold"), made.at("threshold"));
  EXPECT_EQ(others("--others t2.csv"), std::vector<std::string>{"t2.csv"});
  expect_refused(desk().run("baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml -o t1.csv"), "t1.csv");
  expect_refused(desk().run(call + "--others b2.csv"), "b2.csv: is one of the baseline's own logs as well");
  desk().write("t1.csv", bytes_of(desk() / "t1.csv") + "# moved on\n");
  EXPECT_EQ(others(""), std::vector<std::string>{"t2.csv"});
}

TEST_F(MainJob, CheckLogShowsWhereTheTableWasTuned) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  const std::string call = "check-log s1.csv --rig rig.toml --params tuned.csv --json look.json ";
  const Ended ended = desk().run(call + "--report look.html");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("  tuned at supply "), std::string::npos) << ended.out;
  EXPECT_NE(bytes_of(desk() / "look.html").find("logs that tuned"), std::string::npos);
  EXPECT_GT(json("look.json")["logs"][0]["operating_point"][0]["tuned_lowest"], 1e7);
  EXPECT_NE(json("look.json")["inputs"].dump().find("\"t2.csv\""), std::string::npos) << "a log that tuned";
  const std::string manifest = bytes_of(desk() / "tuned.csv.manifest.json");
  std::filesystem::remove(desk() / "tuned.csv.manifest.json");
  EXPECT_EQ(desk().run(call).out.find("tuned at"), std::string::npos);
  EXPECT_TRUE(json("look.json")["logs"][0]["operating_point"][0]["tuned_lowest"].is_null());
  desk().write("tuned.csv.manifest.json", manifest);
}

TEST_F(MainJob, DiagnoseRefusesABaselineThatDoesNotServe) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  desk().write("other.json",
               R"({"command": "baseline", "threshold": 3, "adequacy_limit": 1, "null_limit": 0.05, "tuned_sha256": "0",
                   "false_alarm": {"asked": 0.1, "promised": 0.25, "promised_95": 0.6, "logs": 3, "logs_needed": 9,
                   "statement": ""}, "scores": [{"log": "h.csv", "sha256": "1", "score": 1, "adequacy": 1, "gains": {}}]})");
  const std::string call = "diagnose s1.csv --params tuned.csv --rig rig.toml --baseline ";
  expect_refused(desk().run(call + "other.json"),
                 "other.json: key 'tuned_sha256': was made with another table than tuned.csv");
  desk().write("cut.json", bytes_of(desk() / "other.json").substr(0, 300));
  expect_refused(desk().run(call + "cut.json"), "cut.json:3: is not JSON");
}

TEST_F(MainJob, DiagnoseRefusesATruthOfOtherTypesBeforeItsFits) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  ASSERT_EQ(
      desk()
          .run("baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --quiet -o b.json --false-alarm 0.3")
          .code,
      0);
  desk().write("s1.truth.json", R"({"sha256": 5})");
  // A rehearsal fits nothing.
  expect_refused(
      desk().run("diagnose s1.csv --params tuned.csv --rig rig.toml --baseline b.json --report s1.html --dry-run"),
      "s1.truth.json: key 'sha256': is not a text");
  std::filesystem::remove(desk() / "s1.truth.json");
}

TEST_F(MainJob, BaselineAndDiagnoseWriteTheContractsKeys) {
  ASSERT_EQ(tuned().code, 0) << tuned().err;
  const Ended based = desk().run(
      "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --quiet -o base.json --false-alarm 0.3");
  ASSERT_EQ(based.code, 0) << based.err;
  EXPECT_TRUE(based.out.starts_with("threshold ")) << based.out;
  const Json base = json("base.json");
  expect_header(base, "baseline");
  expect_keys(base, {"threshold", "false_alarm", "scores"});
  expect_keys(base["false_alarm"], {"asked", "promised", "logs", "statement"});
  EXPECT_EQ(base["scores"].size(), 3u);
  EXPECT_EQ(base["false_alarm"]["asked"], 0.3);

  const std::string call = "diagnose s1.csv b1.csv --params tuned.csv --rig rig.toml --baseline base.json --quiet ";
  const Ended diagnosed = desk().run(call + "--exit-code --json verdict.json");
  const Json result = json("verdict.json");
  expect_header(result, "diagnose");
  ASSERT_EQ(result["results"].size(), 2u);
  int worst = 0;
  for (const Json& r : result["results"]) {
    expect_keys(r, {"log", "verdict", "error", "threshold", "p_value", "fault", "probabilities", "ambiguous_with",
                    "separating_test", "severity", "onset_time", "parameters", "faults", "channel", "records"});
    expect_keys(r["severity"], {"value", "lower", "upper", "unit"});
    EXPECT_GT(r["operating_point"][0]["tuned_lowest"], 1e7) << "the baseline keeps the logs that tuned";
    const std::string verdict = r["verdict"];
    worst = std::max(worst, verdict == "fault" ? 10 : verdict == "unknown" ? 11 : 0);
  }
  EXPECT_EQ(result["results"][0]["log"], "s1.csv");
  EXPECT_EQ(diagnosed.code, worst) << diagnosed.err;
  EXPECT_TRUE(diagnosed.out.starts_with("s1.csv: ")) << diagnosed.out;

  // Without --exit-code a verdict is no failure, and the number of threads changes nothing.
  const Ended ended = desk().run(call + "--json - --threads 1");
  EXPECT_EQ(ended.code, 0) << ended.err;
  Json again = Json::parse(ended.out), before = result;
  again.erase("seconds"), before.erase("seconds");
  EXPECT_EQ(again, before);

  // Pooled: one verdict for both.
  ASSERT_EQ(desk().run(call + "--pool --json pool.json --report pool.html").code, 0);
  const Json pool = json("pool.json")["results"];
  ASSERT_EQ(pool.size(), 1u);
  EXPECT_EQ(pool[0]["logs"], Json({"s1.csv", "b1.csv"}));
  EXPECT_EQ(pool[0]["log"], "s1.csv + b1.csv");
}

}  // namespace
}  // namespace servodx
