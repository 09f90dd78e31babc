// diagnose --list and gather, as called: a list is its logs one by one, whatever the way it is cut.
#include "fleet.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>

#include "cli/program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

// What the run says of itself.
Json summary(const Ended& ended) { return Json::parse(ended.out); }

TEST(Fleet, AListGivesTheResultsOfTheLogsOneByOne) {
  const FleetDesk desk;
  desk.write("list.txt", "# two of one name\na/log.csv\n\nb/log.csv\n");
  const Ended ended = desk.list("list.txt --out res --json -");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(summary(ended)["judged"], 2);
  const auto results = desk.results("res");
  ASSERT_EQ(results.size(), 2u);
  for (const auto& [log, result] : results) {
    const Ended alone = desk.run("diagnose " + log + FleetDesk::judged_with + "--threads 1 --json -");
    Json wanted = Json::parse(alone.out);
    wanted.erase("seconds");
    Json found = result;
    EXPECT_EQ(found.erase("commit"), 1u) << "by which a later run knows it";
    EXPECT_EQ(found, wanted) << log;
  }
}

TEST(Fleet, ASecondRunKeepsWhatStandsAndMakesTheRestAnew) {
  const FleetDesk desk;
  desk.write("list.txt", "a/log.csv\nb/log.csv\n");
  ASSERT_EQ(desk.list("list.txt --out res").code, 0);
  const auto before = desk.contents();
  const Ended again = desk.list("list.txt --out res --json -");
  EXPECT_EQ(summary(again)["judged"], 0);
  EXPECT_EQ(summary(again)["stood"], 2);
  EXPECT_EQ(desk.contents(), before);

  // Another log under the name, and a result that is cut short.
  std::string damaged;
  for (const auto& [name, bytes] : before)
    if (name.starts_with("res/") && bytes.find("\"a/log.csv\"") != std::string::npos) damaged = name;
  desk.write(damaged, before.at(damaged).substr(0, 1000));
  EXPECT_EQ(summary(desk.list("list.txt --out res --json -"))["judged"], 1);
  desk.write("b/log.csv", FleetDesk::excerpt("healthy/h04_multisine.csv", 100));
  EXPECT_EQ(summary(desk.list("list.txt --out res --json -"))["judged"], 1);
  EXPECT_EQ(summary(desk.list("list.txt --out res --json - --seed 2"))["judged"], 2);
}

// Whatever changes a result: what a fault asks for, and what is asked of an unknown log.
TEST(Fleet, ASecondRunWithOtherActionsOrQuestionsJudgesAnew) {
  const FleetDesk desk;
  desk.write("list.txt", "b/log.csv\n");
  const auto judged = [&](const std::string& more) {
    const Ended ended = desk.list("list.txt --out res --json - " + more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.code == 0 ? summary(ended)["judged"].get<int>() : -1;
  };
  desk.write("act.toml", "clogged_filter = \"abnormal: flush\"\n");
  EXPECT_EQ(judged("--no-explain"), 1);
  EXPECT_EQ(judged("--no-explain"), 0);
  EXPECT_EQ(judged("--no-explain --actions act.toml"), 1);
  EXPECT_EQ(judged("--no-explain --actions act.toml"), 0);
  const Json result = desk.results("res").at("b/log.csv");
  EXPECT_EQ(result["inputs"].back()["path"], "act.toml");
  EXPECT_EQ(result["settings"]["explain_unknown"], false);
  desk.write("act.toml", "clogged_filter = \"critical: stop\"\n");
  EXPECT_EQ(judged("--no-explain --actions act.toml"), 1);
  EXPECT_EQ(judged("--actions act.toml"), 1);
  EXPECT_EQ(judged("--actions act.toml"), 0);
}

TEST(Fleet, APageALogStandsBesideItsResultAndTheTableLeadsToIt) {
  const FleetDesk desk;
  desk.write("list.txt", "b/log.csv\n");
  const auto page = [&] {
    std::string name;
    for (const auto& entry : std::filesystem::directory_iterator(desk.path / "res"))
      if (entry.path().extension() == ".html") name = entry.path().filename().string();
    return name;
  };
  ASSERT_EQ(desk.list("list.txt --out res --no-explain").code, 0);
  EXPECT_EQ(page(), "");
  const Ended made = desk.list("list.txt --out res --no-explain --pages --json -");
  EXPECT_EQ(summary(made)["judged"], 1) << "a result without its page does not stand: " << made.err;
  ASSERT_NE(page(), "");
  EXPECT_EQ(summary(desk.list("list.txt --out res --no-explain --pages --json -"))["stood"], 1);
  const auto leads_to = [&](const std::string& report, const std::string& address) {
    EXPECT_EQ(desk.run("gather res --quiet --report " + report).code, 0);
    return bytes_of(desk / report).find("<a href=\"" + address + page() + "\">b/log.csv</a>") != std::string::npos;
  };
  EXPECT_TRUE(leads_to("t.html", "res/"));
  EXPECT_TRUE(leads_to("a/t.html", "../res/"));
  // Judged anew without a page: the old one would show another verdict.
  EXPECT_EQ(desk.list("list.txt --out res --no-explain --seed 2").code, 0);
  EXPECT_EQ(page(), "");
}

TEST(Fleet, ABadLogIsSetAsideWithItsReasonAndTheRestIsJudged) {
  const FleetDesk desk;
  desk.write("bad.csv", with_line(FleetDesk::excerpt("healthy/h04_multisine.csv"), 9, "1,2"));
  desk.write("list.txt", "bad.csv\ngone.csv\nb/log.csv\n");
  const Ended ended = desk.list("list.txt --out res --json -");
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_EQ(summary(ended)["judged"], 1);
  EXPECT_EQ(summary(ended)["set_aside"].size(), 2u);
  const auto results = desk.results("res");
  const Json refused = results.at("bad.csv").at("refused");
  EXPECT_EQ(refused["file"], "bad.csv");
  EXPECT_EQ(refused["line"], 9);
  EXPECT_NE(refused["rule"].get<std::string>().find("ragged row"), std::string::npos);
  EXPECT_FALSE(refused["mend"].get<std::string>().empty());
  EXPECT_TRUE(results.at("gone.csv").contains("refused"));
  EXPECT_TRUE(results.at("b/log.csv").contains("results"));

  // A log that was mended has a result and no reason any more.
  desk.write("bad.csv", FleetDesk::excerpt("healthy/h04_multisine.csv"));
  desk.write("gone.csv", FleetDesk::excerpt("healthy/h04_multisine.csv"));
  EXPECT_EQ(desk.list("list.txt --out res").code, 0);
  for (const auto& [log, result] : desk.results("res")) EXPECT_TRUE(result.contains("results")) << log;
  EXPECT_EQ(desk.results("res").size(), 3u);
}

TEST(Fleet, TwoChunksAtOnceEqualOneRun) {
  const FleetDesk desk;
  desk.write("c.csv", FleetDesk::excerpt("healthy/h03_sine_2hz.csv"));
  desk.write("list.txt", "a/log.csv\nb/log.csv\nc.csv\nbad.csv\n");
  ASSERT_EQ(desk.list("list.txt --out one").code, 3);
  const std::string call = "'" + std::string(SERVODX_PROGRAM) + "' diagnose --list list.txt --out two --chunk ";
  const std::string both = "cd '" + desk.path.string() + "' && (" + call + "1/2" + FleetDesk::judged_with +
                           ">1.out 2>&1 & " + call + "2/2" + FleetDesk::judged_with + ">2.out 2>&1; wait)";
  ASSERT_EQ(std::system(both.c_str()), 0);
  EXPECT_EQ(desk.results("two"), desk.results("one"));
}

TEST(Fleet, AListMayComeFromStandardInput) {
  const FleetDesk desk;
  desk.write("list.txt", "b/log.csv\n");
  EXPECT_EQ(desk.list("- --out res <list.txt").code, 0);
  EXPECT_TRUE(desk.results("res").contains("b/log.csv"));
}

TEST(Fleet, AnInterruptedRunKeepsWhatIsDoneAndTheNextGoesOn) {
  const FleetDesk desk;
  std::string list;
  const std::string log = FleetDesk::excerpt("healthy/h04_multisine.csv", 30);
  constexpr int logs = 40;
  for (int k = 0; k < logs; ++k) {
    const std::string name = "l" + std::to_string(k) + ".csv";
    desk.write(name, log);
    list += name + "\n";
  }
  desk.write("list.txt", list);
  // Interrupted once the first result is there, however busy the machine.
  desk.write("until_first",
             "cd '" + desk.path.string() + "'\nset -m\n'" + SERVODX_PROGRAM + "' diagnose --list list.txt --out res" +
                 FleetDesk::judged_with +
                 ">out 2>&1 &\nuntil ls res/*.json >ls 2>&1; do sleep 0.01; done\nkill -INT $!\nwait $!\n");
  const int status = std::system(("bash '" + (desk / "until_first") + "'").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 130) << bytes_of(desk / "out");
  const auto kept = desk.results("res").size();
  EXPECT_GE(kept, 1u);
  ASSERT_LT(kept, static_cast<std::size_t>(logs));
  const Ended rest = desk.list("list.txt --out res --json -");
  EXPECT_EQ(summary(rest)["stood"], kept);
  EXPECT_EQ(desk.results("res").size(), static_cast<std::size_t>(logs));
}

TEST(Fleet, ExitCodeIsOfAllLogsOfTheListJudgedOrStanding) {
  const FleetDesk desk;
  desk.write("list.txt", "a/log.csv\nb/log.csv\n");
  const Ended first = desk.list("list.txt --out res --exit-code --json -");
  const Json verdicts = summary(first)["verdicts"];
  const int wanted = verdicts["unknown"] > 0 ? 11 : verdicts["fault"] > 0 ? 10 : 0;
  EXPECT_EQ(first.code, wanted);
  EXPECT_EQ(desk.list("list.txt --out res --exit-code").code, wanted);
}

TEST(Fleet, CallsThatCannotBeAreRefusedBeforeTheWork) {
  const FleetDesk desk;
  desk.write("list.txt", "b/log.csv\n");
  desk.write("empty.txt", "# nothing\n");
  const auto before = desk.contents();
  for (const char* call :
       {"list.txt", "list.txt --out list.txt", "list.txt --out no/where", "gone.txt --out res", "empty.txt --out res",
        "list.txt --out res --chunk 3/2", "list.txt --out res b/log.csv", "list.txt --out res --report page.html",
        "list.txt --out res --pdf page.pdf", "list.txt --out res --pool", "list.txt --out res --population 60",
        "list.txt --out res --search genetic"}) {
    const Ended ended = desk.list(call);
    EXPECT_EQ(ended.code, 2) << call << ": " << ended.err;
    EXPECT_NE(ended.err.find("; "), std::string::npos) << ended.err;
  }
  const Ended none = desk.run("diagnose --params tuned.csv --baseline base.json");
  EXPECT_EQ(none.code, 2);
  EXPECT_EQ(desk.run("diagnose --out res --params tuned.csv --baseline base.json b/log.csv").code, 2);
  EXPECT_EQ(desk.list("list.txt --out res --dry-run").code, 0);
  EXPECT_EQ(desk.contents(), before);
}

TEST(Fleet, GatherShowsTheFolderAndSaysWhatIsNoResult) {
  const FleetDesk desk;
  desk.write("list.txt", "a/log.csv\nb/log.csv\ngone.csv\n");
  ASSERT_EQ(desk.list("list.txt --out res").code, 3);
  const std::string call = "gather res --truth truth.csv --quiet -o t.csv --report t.html --json t.json";
  desk.write("truth.csv", "log,class,severity\na/log.csv,clogged_filter,0.75\nb/log.csv,healthy,\n");
  const Ended ended = desk.run(call);
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("2 logs: ")) << ended.out;
  const Json json = Json::parse(bytes_of(desk / "t.json"));
  EXPECT_EQ(json["command"], "gather");
  EXPECT_EQ(json["results"].size(), 2u);
  EXPECT_EQ(json["set_aside"].size(), 1u);
  EXPECT_EQ(json["confusion"]["classes"].size(), 2u);
  EXPECT_EQ(json["calibration"]["right"]["of"],
            json["logs"].get<long>() - json["verdicts"].value("healthy", 0L) - json["verdicts"].value("unknown", 0L));
  EXPECT_EQ(json["detectable_found"]["bands"].size(), 6u);
  EXPECT_NE(ended.out.find("\nFaults of known size beside the least that their logs would have shown\n"),
            std::string::npos)
      << ended.out;
  for (const char* file : {"t.html", "t.csv"})
    for (const char* log : {"a/log.csv", "b/log.csv"})
      EXPECT_NE(bytes_of(desk / file).find(log), std::string::npos) << file;
  desk.write("res/half.json", "{\"tool\": ");
  const Ended damaged = desk.run(call);
  EXPECT_EQ(damaged.code, 3);
  EXPECT_NE(damaged.out.find("half.json: is no whole JSON; "), std::string::npos) << damaged.out;
  EXPECT_EQ(Json::parse(bytes_of(desk / "t.json"))["results"].size(), 2u);
}

}  // namespace
}  // namespace servodx
