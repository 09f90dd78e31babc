// check --list as called: a list is its checks one by one, in its order, each once in the history.
#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "base/sha256.h"
#include "cli/fleet.h"
#include "cli/program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

Json summary(const Ended& ended) { return Json::parse(ended.out); }

struct CheckDesk : FleetDesk {
  CheckDesk() {
    write("c.csv", excerpt("healthy/h03_sine_2hz.csv"));
    write("checks.csv", list);
  }
  // The third and fourth at the same hours, the last one ahead of the others of its valve.
  static constexpr const char* list =
      "log,valve,hours\nb/log.csv,V7,10\na/log.csv,V8,10\nc.csv,V7,20.5\na/log.csv,V7,20.5\nb/log.csv,V8,5\n";
  static constexpr std::size_t rows = 5;
  static constexpr const char* with = " --params tuned.csv --rig rig.toml --quiet ";

  Ended check(const std::string& more) const { return run("check " + more + with); }
  // The history as CSV, the moments of writing left out. Checks of one valve at one hour stand in the order of writing.
  std::string history(const std::string& name) const {
    const Ended ended = run("history export --history " + name + " -o export.csv --quiet");
    EXPECT_EQ(ended.code, 0) << ended.err;
    static const std::regex moment(R"(\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ)");
    return std::regex_replace(bytes_of(*this / "export.csv"), moment, "");
  }
  std::size_t recorded(const std::string& name) const {
    const Json shown = Json::parse(run("history show --history " + name + " --quiet --json -").out);
    std::size_t n = 0;
    for (const Json& valve : shown["valves"]) n += valve["checks"].get<std::size_t>();
    return n;
  }
};

TEST(CheckList, EachRowIsInTheHistoryOnceAsTheChecksOneByOneLeaveIt) {
  const CheckDesk desk;
  const Ended ended = desk.check("--list checks.csv --history h.db --out res --json -");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(summary(ended)["recorded"], CheckDesk::rows);
  EXPECT_EQ(desk.recorded("h.db"), CheckDesk::rows);
  std::map<std::string, Json> results;
  for (const auto& entry : std::filesystem::directory_iterator(desk / "res")) {
    Json result = Json::parse(bytes_of(entry.path()));
    result.erase("seconds");
    result["settings"].erase("history");
    results[result["settings"]["valve"].get<std::string>() + result["settings"]["at"].dump() +
            result["log"].get<std::string>()] = result;
  }
  ASSERT_EQ(results.size(), CheckDesk::rows);
  for (const auto& [log, valve, at] : std::vector<std::array<std::string, 3>>{{"b/log.csv", "V7", "10.0"},
                                                                              {"a/log.csv", "V8", "10.0"},
                                                                              {"c.csv", "V7", "20.5"},
                                                                              {"a/log.csv", "V7", "20.5"},
                                                                              {"b/log.csv", "V8", "5.0"}}) {
    const Ended alone = desk.check(log + " --history one.db --json - --valve " + valve + " --at " + at);
    ASSERT_EQ(alone.code, 0) << alone.err;
    Json wanted = Json::parse(alone.out);
    wanted.erase("seconds");
    wanted["settings"].erase("history");
    EXPECT_EQ(results[valve + at + log], wanted);
  }
  EXPECT_EQ(desk.history("h.db"), desk.history("one.db"));
}

TEST(CheckList, ASecondRunPassesOverWhatTheHistoryHolds) {
  const CheckDesk desk;
  ASSERT_EQ(desk.check("--list checks.csv --history h.db").code, 0);
  const std::string before = desk.history("h.db");
  const Ended again = desk.check("--list checks.csv --history h.db --json -");
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(summary(again)["recorded"], 0);
  EXPECT_EQ(summary(again)["stood"], CheckDesk::rows);
  EXPECT_EQ(summary(again)["simulations"], 0);  // none is made again only to find that it is there
  EXPECT_EQ(desk.history("h.db"), before);

  // What one check recorded stands; other hours, other bytes and another table do not.
  desk.write("more.csv", std::string(CheckDesk::list) + "b/log.csv,V7,30\nc.csv,V9,1\n");
  ASSERT_EQ(desk.check("c.csv --history h.db --valve V9 --at 1").code, 0);
  EXPECT_EQ(summary(desk.check("--list more.csv --history h.db --json -"))["recorded"], 1);
  desk.write("c.csv", FleetDesk::excerpt("healthy/h03_sine_2hz.csv", 110));
  EXPECT_EQ(summary(desk.check("--list more.csv --history h.db --json -"))["recorded"], 2);
  desk.write("tuned.csv", "# another\n" + FleetDesk::as_tuned());
  EXPECT_EQ(summary(desk.check("--list more.csv --history h.db --json -"))["recorded"], CheckDesk::rows + 2);
}

TEST(CheckList, ABadLogIsSetAsideWithItsReasonAndTheRestIsRecorded) {
  const CheckDesk desk;
  desk.write("bad.csv", with_line(FleetDesk::excerpt("healthy/h04_multisine.csv"), 9, "1,2"));
  desk.write("mixed.csv", "log,valve,hours\nbad.csv,V7,1\ngone.csv,V7,2\nb/log.csv,V7,3\n");
  const Ended ended = desk.check("--list mixed.csv --history h.db --out res --json -");
  EXPECT_EQ(ended.code, 3) << ended.err;
  const Json told = summary(ended);
  EXPECT_EQ(told["recorded"], 1);
  ASSERT_EQ(told["set_aside"].size(), 2u);
  EXPECT_EQ(told["set_aside"][0]["file"], "bad.csv");
  EXPECT_EQ(told["set_aside"][0]["line"], 9);
  EXPECT_NE(told["set_aside"][0]["rule"].get<std::string>().find("ragged row"), std::string::npos);
  EXPECT_FALSE(told["set_aside"][1]["mend"].get<std::string>().empty());
  EXPECT_EQ(desk.recorded("h.db"), 1u);
  std::size_t reasons = 0;
  for (const auto& entry : std::filesystem::directory_iterator(desk / "res"))
    reasons += Json::parse(bytes_of(entry.path())).contains("refused");
  EXPECT_EQ(reasons, 2u);

  // Logs that were mended are recorded and have no reason any more.
  for (const char* name : {"bad.csv", "gone.csv"}) desk.write(name, FleetDesk::excerpt("healthy/h03_sine_2hz.csv"));
  const Ended mended = desk.check("--list mixed.csv --history h.db --out res --json -");
  EXPECT_EQ(mended.code, 0) << mended.err;
  EXPECT_EQ(summary(mended)["recorded"], 2);
  for (const auto& entry : std::filesystem::directory_iterator(desk / "res"))
    EXPECT_FALSE(Json::parse(bytes_of(entry.path())).contains("refused")) << entry.path();
}

TEST(CheckList, WhereEveryLogIsBadNoHistoryIsMade) {
  const CheckDesk desk;
  desk.write("gone.csv", "log,valve,hours\nnowhere.csv,V7,1\n");
  EXPECT_EQ(desk.check("--list gone.csv --history h.db").code, 3);
  EXPECT_FALSE(std::filesystem::exists(desk / "h.db"));
}

// Ended by `signal` once two results are there, however busy the machine; the code of the end.
int end_early(const CheckDesk& desk, const std::string& signal) {
  desk.write("until_second", "cd '" + desk.path.string() + "'\nset -m\n'" + SERVODX_PROGRAM +
                                 "' check --list many.csv --history h.db --out res --threads 1" + CheckDesk::with +
                                 ">out 2>&1 &\nuntil [ \"$(ls res/*.json 2>/dev/null | wc -l)\" -ge 2 ]; do sleep "
                                 "0.01; done\nkill -" +
                                 signal + " $!\nwait $!\n");
  const int status = std::system(("bash '" + (desk / "until_second") + "'").c_str());
  return WEXITSTATUS(status);
}

TEST(CheckList, AnInterruptedOrKilledRunIsGoneOnWithToTheHistoryOfOneRun) {
  constexpr std::size_t checks = 40;
  std::string many = "log,valve,hours\n";
  for (std::size_t k = 0; k < checks; ++k)
    many += std::string(k % 3 ? "b/log.csv" : "c.csv") + ",V" + std::to_string(k % 2) + "," + std::to_string(k) + "\n";
  const CheckDesk undisturbed;
  undisturbed.write("many.csv", many);
  ASSERT_EQ(undisturbed.check("--list many.csv --history h.db --threads 1").code, 0);
  for (const auto& [signal, code] : {std::pair("INT", 130), std::pair("TERM", 130), std::pair("KILL", 137)}) {
    const CheckDesk desk;
    desk.write("many.csv", many);
    EXPECT_EQ(end_early(desk, signal), code) << bytes_of(desk / "out");
    const std::size_t kept = desk.recorded("h.db");
    EXPECT_GE(kept, 1u);
    ASSERT_LT(kept, checks);
    const Ended rest = desk.check("--list many.csv --history h.db --out res --threads 1 --json -");
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(summary(rest)["stood"], kept);
    EXPECT_EQ(summary(rest)["recorded"], checks - kept);
    EXPECT_EQ(desk.history("h.db"), undisturbed.history("h.db")) << signal;
    for (const auto& entry : std::filesystem::directory_iterator(desk / "res"))
      EXPECT_TRUE(Json::accept(bytes_of(entry.path()))) << entry.path();
  }
}

TEST(CheckList, TheHistoryIsTheSameAtOneThreadAndAtTwo) {
  const CheckDesk desk;
  ASSERT_EQ(desk.check("--list checks.csv --history one.db --threads 1").code, 0);
  ASSERT_EQ(desk.check("--list checks.csv --history two.db --threads 2").code, 0);
  const std::string one = desk.history("one.db");
  EXPECT_EQ(one, desk.history("two.db"));
  // By the list's order: of the two at one hour the one that stands first in it.
  EXPECT_LT(one.find(",c.csv,"), one.rfind(",a/log.csv,", one.find("V8,")));
}

TEST(CheckList, ARowIsCheckedWithTheTableThatItNames) {
  const CheckDesk desk;
  desk.write("other.csv", "# another\n" + FleetDesk::as_tuned());
  desk.write("own.csv", "log,valve,hours,params\nb/log.csv,V7,1,other.csv\nb/log.csv,V8,1,\n");
  ASSERT_EQ(desk.check("--list own.csv --history h.db").code, 0);
  const std::string tables = desk.history("h.db");
  EXPECT_NE(tables.find(sha256("# another\n" + FleetDesk::as_tuned())), std::string::npos);
  EXPECT_NE(tables.find(sha256(FleetDesk::as_tuned())), std::string::npos);
  const Ended none = desk.run("check --list own.csv --history n.db --quiet");
  EXPECT_EQ(none.code, 2);
  EXPECT_NE(none.err.find("own.csv:3: column 'params'"), std::string::npos) << none.err;
}

TEST(CheckList, AListMayComeFromStandardInput) {
  const CheckDesk desk;
  EXPECT_EQ(desk.check("--list - --history h.db <checks.csv").code, 0);
  EXPECT_EQ(desk.recorded("h.db"), CheckDesk::rows);
}

TEST(CheckList, ABadListIsRefusedAtItsPlaceAndNothingIsWritten) {
  const CheckDesk desk;
  desk.write("ragged.csv", "log,valve,hours\nb/log.csv,V7,1\nb/log.csv,V7\n");
  desk.write("late.csv", "log,valve,hours\nb/log.csv,V7,1\nb/log.csv,V7,soon\n");
  desk.write("paths.csv", "b/log.csv\n");
  desk.write("table.csv", "log,valve,hours,params\nb/log.csv,V7,1,nowhere.csv\n");
  const auto before = desk.contents();
  struct Case {
    const char *list, *told;
  };
  for (const Case& c : std::vector<Case>{{"ragged.csv", "ragged.csv:3: has 2 cells, the header 3; "},
                                         {"late.csv", "late.csv:3: column 'hours': 'soon' is not a number"},
                                         {"paths.csv", "paths.csv:1: column 'log': "},
                                         {"table.csv", "nowhere.csv: "},
                                         {"gone.csv", "gone.csv: "}}) {
    const Ended ended = desk.check(std::string("--history h.db --out res --list ") + c.list);
    EXPECT_EQ(ended.code, 2) << c.list << ": " << ended.err;
    EXPECT_NE(ended.err.find(c.told), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("; "), std::string::npos) << ended.err;
  }
  for (const char* call : {"b/log.csv --list checks.csv", "--list checks.csv --valve V7", "--list checks.csv --at 1",
                           "--list checks.csv --report page.html", "--list checks.csv --out no/where",
                           "--out res b/log.csv --valve V7 --at 1", "--valve V7 --at 1", "b/log.csv --at 1",
                           "b/log.csv --valve V7", "--list checks.csv --json b/log.csv"})
    EXPECT_EQ(desk.check(std::string("--history h.db ") + call).code, 2) << call;
  EXPECT_EQ(desk.check("--list checks.csv --history h.db --out res --dry-run").code, 0);
  EXPECT_EQ(desk.contents(), before);
}

}  // namespace
}  // namespace servodx
