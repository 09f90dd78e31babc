// Calls that were broken off and go on from their checkpoints, on short excerpts of the shipped logs. scripts/
// kill_and_resume does it with real kills.
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "program.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

struct Call {
  std::string name, words, table, result;  // table: empty where it writes none
};

class GoingOn : public testing::TestWithParam<Call> {
 protected:
  static const Desk& desk() {
    static const std::unique_ptr<Desk> made = [] {
      auto desk = std::make_unique<Desk>();
      write_rig_and_baseline_logs(*desk);
      desk->write("t1.csv", excerpt("healthy/h12_mixed.csv", 500));
      desk->write("s1.csv", excerpt("fault/f02_clogged_filter_severe.csv", 300));
      desk->write("s2.csv", excerpt("healthy/h02_steps_small.csv", 300));
      EXPECT_EQ(desk->run("tune t1.csv --params table.csv --rig rig.toml --generations 0 --effects none --quiet "
                          "-o tuned.csv")
                    .code,
                0);
      EXPECT_EQ(desk->run("baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --alone --quiet "
                          "-o base.json")
                    .code,
                0);
      return desk;
    }();
    return *made;
  }
  static std::string bits(const Call& call) {
    Json result = Json::parse(bytes_of(desk() / call.result));
    result.erase("seconds");
    if (result.contains("local"))  // a tune's steps
      for (Json& step : result["local"]["stages"]) step.erase("seconds");
    return result.dump() + (call.table.empty() ? "" : bytes_of(desk() / call.table)) +
           (call.words.find(" --report o.html ") == std::string::npos ? "" : bytes_of(desk() / "o.html"));
  }
  // Ended by Ctrl-C once the first stage is finished, however busy the machine is: the checkpoint then holds more than
  // its first line.
  static Ended interrupted(const std::string& words, const std::string& checkpoint) {
    const TemporaryFolder streams;
    const std::string kept = "'" + (desk() / checkpoint) + "'", out = streams / "out", err = streams / "err";
    const int status = std::system(("cd '" + desk().path.string() + "' && rm -f " + kept + "; '" + SERVODX_PROGRAM +
                                    "' " + words + "--checkpoint " + checkpoint + " >'" + out + "' 2>'" + err +
                                    "' & pid=$!; while kill -0 $pid && ! find " + kept + " -size +21c | grep -q ." +
                                    "; do sleep 0.01; done 2>/dev/null; kill -INT $pid 2>/dev/null; wait $pid")
                                       .c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes_of(out), bytes_of(err)};
  }
  static void cut(const std::string& file, double part) {
    const std::filesystem::path path = desk() / file;
    std::filesystem::resize_file(
        path, static_cast<std::uintmax_t>(part * static_cast<double>(std::filesystem::file_size(path))));
  }
};

// Cut where a kill might have, wherever in a stage that is: what was finished is not made again, and no bit differs.
TEST_P(GoingOn, ComesToTheBitsOfAnUnbrokenCall) {
  const Call& call = GetParam();
  ASSERT_EQ(desk().run(call.words + "--quiet").code, 0);
  const std::string unbroken = bits(call);
  const Ended kept = desk().run(call.words + "--checkpoint kept");
  ASSERT_EQ(kept.code, 0) << kept.err;
  EXPECT_EQ(bits(call), unbroken);
  for (const double part : {0.3, 0.8, 1.0}) {
    cut("kept", part);
    std::filesystem::remove(desk() / call.result);
    const Ended resumed = desk().run(call.words + "--threads 1 --checkpoint kept --resume");
    ASSERT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(bits(call), unbroken) << part;
    const auto at = resumed.err.find(" finished stages were taken from it, ");
    ASSERT_NE(at, std::string::npos) << resumed.err;
    if (part == 1.0) {
      EXPECT_NE(resumed.err.find("taken from it, 0 were made"), std::string::npos) << resumed.err;
    }
  }
}

TEST_P(GoingOn, AfterAnInterruptSaysHowTo) {
  const Call& call = GetParam();
  const Ended ended = interrupted(call.words, "broken_off");
  ASSERT_EQ(ended.code, 130) << ended.out << ended.err;
  EXPECT_NE(
      ended.out.find("interrupted: to go on, give the same call with --resume; what is finished is in broken_off"),
      std::string::npos)
      << ended.out;
  const Ended resumed = desk().run(call.words + "--checkpoint broken_off --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find(" finished stages were taken from it, "), std::string::npos) << resumed.err;
  const std::string gone_on = bits(call);
  ASSERT_EQ(desk().run(call.words + "--quiet").code, 0);
  EXPECT_EQ(bits(call), gone_on);
}

TEST_P(GoingOn, AtALimitOfTimeSaysHowTo) {
  const Call& call = GetParam();
  const Ended ended = desk().run(call.words + "--checkpoint limited --time-limit '1 ms'");
  EXPECT_EQ(ended.code, 130) << ended.err;
  EXPECT_NE(ended.out.find("ended by the time limit of 1 ms: to go on, give the same call with --resume"),
            std::string::npos)
      << ended.out;
  const Ended resumed = desk().run(call.words + "--quiet --checkpoint limited --resume");
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  const std::string gone_on = bits(call);
  ASSERT_EQ(desk().run(call.words + "--quiet").code, 0);
  EXPECT_EQ(bits(call), gone_on);
}

const std::string judged = "--params tuned.csv --baseline base.json --rig rig.toml ";

INSTANTIATE_TEST_SUITE_P(
    Every, GoingOn,
    testing::Values(
        Call{"Tune",
             "tune t1.csv --params table.csv --rig rig.toml --effects none --population 64 --generations 3 --rounds 1 "
             "-o o.csv --json o.json --report o.html ",
             "o.csv", "o.json"},
        Call{"Baseline", "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --alone -o o.json ", "",
             "o.json"},
        Call{"Diagnose", "diagnose s1.csv s2.csv " + judged + "--json o.json ", "", "o.json"},
        Call{"Pool", "diagnose s1.csv s2.csv --pool " + judged + "--json o.json ", "", "o.json"},
        Call{"Explain", "explain s1.csv " + judged + "-o o.csv --json o.json ", "o.csv", "o.json"}),
    [](const auto& call) { return call.param.name; });

using GoingOnFrom = GoingOn;

// Of a pool: one state, seen in several logs.
TEST_F(GoingOnFrom, TheOrderOfAPoolsLogsChangesNoVerdict) {
  const auto judged_in = [&](const std::string& logs, const std::string& result) {
    EXPECT_EQ(desk().run("diagnose " + logs + " --pool " + judged + "--quiet --json " + result).code, 0);
    Json out = Json::parse(bytes_of(desk() / result)).at("results").at(0);
    for (const char* of_order : {"log", "logs", "notes"}) out.erase(of_order);
    return out;
  };
  const Json given = judged_in("s1.csv s2.csv", "given.json"), turned = judged_in("s2.csv s1.csv", "turned.json");
  for (const auto& [key, value] : given.items()) EXPECT_EQ(value.dump(), turned.value(key, Json()).dump()) << key;
}

TEST_F(GoingOnFrom, AnotherCallsCheckpointMakesAllAnew) {
  const std::string diagnose = "diagnose s1.csv " + judged + "--checkpoint other ";
  ASSERT_EQ(desk().run(diagnose).code, 0);
  const Ended of_another_log = desk().run("diagnose s2.csv " + judged + "--checkpoint other --resume --json o.json");
  EXPECT_EQ(of_another_log.code, 0);
  EXPECT_NE(of_another_log.err.find("nothing in it is of this call"), std::string::npos) << of_another_log.err;
}

TEST_F(GoingOnFrom, ADamagedEndIsSaid) {
  const std::string diagnose = "diagnose s1.csv " + judged + "--checkpoint damaged ";
  ASSERT_EQ(desk().run(diagnose).code, 0);
  std::filesystem::resize_file(desk() / "damaged", std::filesystem::file_size(desk() / "damaged") - 1);
  const Ended resumed = desk().run(diagnose + "--resume");
  EXPECT_EQ(resumed.code, 0);
  EXPECT_NE(resumed.err.find("damaged: its last "), std::string::npos) << resumed.err;
}

TEST_F(GoingOnFrom, WhatIsNoCheckpointIsRefused) {
  for (const std::string call :
       {"tune t1.csv --params table.csv -o o.csv", "explain s1.csv --params tuned.csv -o o.csv",
        "baseline b1.csv b2.csv b3.csv --params tuned.csv -o o.json"}) {
    const auto refused = [&](const std::string& more) {
      const auto before = desk().contents();
      const Ended ended = desk().run(call + more);
      EXPECT_EQ(ended.code, 2) << ended.err;
      EXPECT_EQ(desk().contents(), before);
      return ended.err;
    };
    EXPECT_NE(refused(" --resume").find("add --checkpoint FILE"), std::string::npos);
    EXPECT_NE(refused(" --resume --checkpoint missing").find("is not there"), std::string::npos);
    EXPECT_NE(refused(" --checkpoint table.csv --resume").find("table.csv"), std::string::npos);
    EXPECT_NE(refused(" --time-limit 90").find("'90 s'"), std::string::npos);
    EXPECT_NE(refused(" --time-limit '0 s'").find("is no duration"), std::string::npos);
  }
}

// The best so far of an explanation is its table, which goes on as the tuned one does; of a baseline, the logs that
// were scored, where they are enough.
TEST_F(GoingOnFrom, AnInterruptLeavesTheBestSoFar) {
  ASSERT_EQ(interrupted("explain s1.csv " + judged + "-o part.csv --json part.json ", "cut_explain").code, 130);
  EXPECT_EQ(desk().run("list params --params part.csv").code, 0);
  const Ended baseline = interrupted(
      "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --alone -o part_base.json ", "cut_baseline");
  ASSERT_EQ(baseline.code, 130) << baseline.err;
  const bool enough = std::filesystem::exists(desk() / "part_base.json");
  EXPECT_EQ(baseline.out.find("too few for a baseline: none is written") == std::string::npos, enough) << baseline.out;
  if (enough) {
    EXPECT_EQ(desk().run("diagnose s2.csv --params tuned.csv --rig rig.toml --baseline part_base.json").code, 0);
  }
}

// Half a judgement is none: no verdict is told, and no baseline that sets no threshold is left behind.
TEST_F(GoingOnFrom, ALimitOfTimeLeavesNoHalfJudgement) {
  ASSERT_EQ(desk().run("diagnose s1.csv " + judged + "--json half.json --time-limit '1 ms'").code, 130);
  EXPECT_EQ(Json::parse(bytes_of(desk() / "half.json")).at("results").size(), 0u);
  const Ended baseline = desk().run(
      "baseline b1.csv b2.csv b3.csv --params tuned.csv --rig rig.toml --alone -o half_base.json --time-limit '1 ms'");
  EXPECT_EQ(baseline.code, 130);
  EXPECT_NE(baseline.out.find("too few for a baseline"), std::string::npos) << baseline.out;
  EXPECT_FALSE(std::filesystem::exists(desk() / "half_base.json"));
}

}  // namespace
}  // namespace servodx
