// What logs are judged by, as called: a baseline's schema, its rig file, the file of actions.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"
#include "fleet.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

struct JudgingDesk : FleetDesk {
  // The baseline with one key in its place; null: without it.
  void set(const std::string& key, const Json& value) const {
    Json base = Json::parse(bytes_of(path / "base.json"));
    base.erase(key);
    if (!value.is_null()) base[key] = value;
    write("base.json", base.dump());
  }
  Ended dry(const std::string& more) const {
    return run("diagnose b/log.csv --dry-run --params tuned.csv --baseline base.json " + more);
  }
  long notes_with(const std::string& words) const {
    const Ended ended = run("diagnose b/log.csv --params tuned.csv --baseline base.json --no-explain --json - --quiet");
    EXPECT_EQ(ended.code, 0) << ended.err;
    const Json notes = Json::parse(ended.out)["notes"];
    return std::count_if(notes.begin(), notes.end(),
                         [&](const Json& n) { return n.get<std::string>().find(words) != std::string::npos; });
  }
};

TEST(Judging, ANewerBaselineIsRefusedAnOlderOneIsReadWithOneNotice) {
  const JudgingDesk desk;
  EXPECT_EQ(desk.dry("--rig rig.toml").code, 0);
  EXPECT_EQ(desk.notes_with("schema"), 0);
  desk.set("schema", nullptr);
  EXPECT_EQ(desk.notes_with("carries no schema"), 1);
  desk.set("schema", 99);
  const Ended newer = desk.dry("--rig rig.toml");
  EXPECT_EQ(newer.code, 2);
  EXPECT_NE(newer.err.find("base.json: key 'schema': 99 is newer"), std::string::npos) << newer.err;
}

TEST(Judging, ABaselineWithAWrongTypeIsRefusedInARehearsalToo) {
  const JudgingDesk desk;
  desk.set("explain", Json::array({1}));
  const Ended ended = desk.dry("--rig rig.toml");
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("is not as 'baseline' writes it"), std::string::npos) << ended.err;
}

TEST(Judging, ABaselineMadeWithARigFileIsNotUsedWithoutOneInSilence) {
  const JudgingDesk desk;
  EXPECT_EQ(desk.notes_with("MADE WITH A RIG FILE"), 0);
  desk.set("inputs", {{{"path", "rig.toml"}, {"sha256", "1"}}, {{"path", "tuned.csv"}, {"sha256", "2"}}});
  EXPECT_EQ(desk.notes_with("MADE WITH A RIG FILE"), 1);
}

// By what it says, not by its name or its columns: another recorder needs another mapping.
TEST(Judging, ARigFileThatSaysOtherThingsThanTheBaselinesIsSaidUnderTheVerdict) {
  const JudgingDesk desk;
  const auto verdict = [&] {
    return desk.run("diagnose b/log.csv --params tuned.csv --baseline base.json --no-explain --quiet --rig rig.toml")
        .out;
  };
  EXPECT_EQ(verdict().find("BEWARE"), std::string::npos) << "an older baseline says nothing of its rig";
  desk.set("made_of", {{"rig", {{"null_limit", "0.05"}, {"supply.pressure", "1"}}}, {"signals", {"flow_a"}}});
  const std::string said = verdict();
  EXPECT_NE(said.find("rig.toml SAYS OTHER THINGS OF THE RIG"), std::string::npos) << said;
  EXPECT_NE(said.find(": actuator.area_a, "), std::string::npos) << said;
  EXPECT_NE(said.find("b/log.csv: lacks flow_a, which every log of the baseline holds"), std::string::npos) << said;
}

TEST(Judging, ARehearsalReadsTheFileOfActions) {
  const JudgingDesk desk;
  desk.write("act.toml", "clogged_philtre = \"abnormal: flush\"\n");
  for (const std::string call : {"diagnose b/log.csv --actions act.toml --dry-run",
                                 "diagnose --list list.txt --out res --actions act.toml --dry-run"}) {
    desk.write("list.txt", "b/log.csv\n");
    const Ended ended = desk.run(call + FleetDesk::judged_with);
    EXPECT_EQ(ended.code, 2) << call;
    EXPECT_NE(ended.err.find("act.toml"), std::string::npos) << ended.err;
  }
}

TEST(Judging, TheLastTestIsOneVerdictBesideOneVerdict) {
  const JudgingDesk desk;
  const auto refusal = [&](const std::string& call, const std::string& words) {
    const Ended ended = desk.run(call + " --against last.json --dry-run" + FleetDesk::judged_with);
    EXPECT_EQ(ended.code, 2) << call;
    EXPECT_NE(ended.err.find(words), std::string::npos) << ended.err;
  };
  desk.write("list.txt", "b/log.csv\n");
  desk.write("last.json", R"({"tool": "servodx", "command": "diagnose", "results": [{"log": "x.csv"}]})");
  refusal("diagnose b/log.csv b/log.csv", "--against");
  refusal("diagnose --list list.txt --out res", "--against");
  desk.write("last.json", R"({"tool": "servodx", "command": "tune"})");
  refusal("diagnose b/log.csv", "last.json: column 'results': is no result of 'diagnose'");
}

// The page has the last test, the valve's frequency response and the place of the test in its head; the JSON the
// change.
TEST(Judging, AVerdictStandsBesideTheLastOneAndTheTunedValve) {
  const JudgingDesk desk;
  const std::string call = std::string("diagnose b/log.csv --no-explain --quiet") + FleetDesk::judged_with;
  ASSERT_EQ(desk.run(call + " --json last.json").code, 0);
  const Ended ended = desk.run(call + " --against last.json --json now.json --report now.html");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("since the last test, last.json: as in the last test"), std::string::npos) << ended.out;
  const Json now = Json::parse(bytes_of(desk.path / "now.json"));
  EXPECT_EQ(now["last_test"]["change"], "alike");
  EXPECT_EQ(now["last_test"]["same_reference"], true);
  EXPECT_FALSE(Json::parse(bytes_of(desk.path / "last.json")).contains("last_test"));
  const std::string page = bytes_of(desk.path / "now.html");
  EXPECT_NE(page.find("<h2>Since the last test</h2>"), std::string::npos);
  const bool holds_a_valve = now["results"][0]["verdict"] != "unknown";
  EXPECT_EQ(page.find("<h2>Frequency response</h2>") != std::string::npos, holds_a_valve);
}

}  // namespace
}  // namespace servodx
