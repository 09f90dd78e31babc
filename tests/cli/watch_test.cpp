// watch DIR, as called: what comes is judged once, what is bad is set aside, a kill loses nothing.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/program.h"
#include "fleet.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

struct WatchDesk : FleetDesk {
  WatchDesk() { std::filesystem::create_directory(path / "in"); }
  Ended once(const std::string& more = "") const {
    return run("watch in --out res --once --settle 0 " + more + judged_with);
  }
};

TEST(Watch, LogsOfTheFolderGetTheResultsOfDiagnose) {
  const WatchDesk desk;
  desk.write("in/one.csv", FleetDesk::excerpt("healthy/h04_multisine.csv"));
  desk.write("in/notes.md", "no log");
  const Ended ended = desk.once();
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(ended.out.starts_with("in/one.csv: ")) << ended.out;
  const auto results = desk.results("res");
  ASSERT_EQ(results.size(), 1u);
  Json alone = Json::parse(desk.run("diagnose in/one.csv" + std::string(FleetDesk::judged_with) + "--json -").out);
  alone.erase("seconds");
  Json watched = results.at("in/one.csv");
  EXPECT_EQ(watched.erase("commit"), 1u) << "by which a later watch knows it";
  EXPECT_EQ(watched, alone);
}

TEST(Watch, WhatIsThereIsKeptWhatIsNewIsJudgedWhatIsBadIsSetAside) {
  const WatchDesk desk;
  const std::string log = FleetDesk::excerpt("healthy/h04_multisine.csv");
  desk.write("in/one.csv", log);
  ASSERT_EQ(desk.once().code, 0);
  desk.write("in/two.csv", FleetDesk::excerpt("healthy/h03_sine_2hz.csv"));
  desk.write("in/bad.csv", with_line(log, 9, "1,2"));
  const Ended ended = desk.once("--json -");
  EXPECT_EQ(ended.code, 3);
  const Json summary = Json::parse(ended.out);
  EXPECT_EQ(summary["stood"], 1);
  EXPECT_EQ(summary["judged"], 1);
  ASSERT_EQ(summary["set_aside"].size(), 1u);
  EXPECT_EQ(summary["set_aside"][0]["file"], "in/bad.csv");
  EXPECT_EQ(desk.results("res").at("in/bad.csv")["refused"]["line"], 9);
}

TEST(Watch, PrometheusIsToldOfEachValveAlsoByAWatchThatGoesOn) {
  const WatchDesk desk;
  desk.write("in/V7_0001.csv", FleetDesk::excerpt("healthy/h04_multisine.csv"));
  ASSERT_EQ(desk.once("--prometheus servodx.prom").code, 0);
  const std::string first = bytes_of(desk / "servodx.prom");
  EXPECT_NE(first.find("servodx_valve_error_ratio{valve=\"V7\"} "), std::string::npos) << first;
  EXPECT_NE(first.find("servodx_valve_last_seen_timestamp_seconds{valve=\"V7\"} "), std::string::npos) << first;
  EXPECT_NE(first.find("servodx_logs_set_aside 0"), std::string::npos) << first;
  desk.write("in/V8_0001.csv", FleetDesk::excerpt("healthy/h03_sine_2hz.csv"));
  desk.write("in/bad.csv", "no log\n");
  EXPECT_EQ(desk.once("--prometheus servodx.prom").code, 3);
  const std::string second = bytes_of(desk / "servodx.prom");
  const auto line_of = [](const std::string& text, const std::string& of) {
    const auto at = text.find(of);
    return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
  };
  const std::string ratio = "servodx_valve_error_ratio{valve=\"V7\"}";
  EXPECT_EQ(line_of(second, ratio), line_of(first, ratio));  // judged by the watch that ended
  EXPECT_NE(second.find("{valve=\"V8\"}"), std::string::npos) << second;
  EXPECT_NE(second.find("servodx_logs_set_aside 1"), std::string::npos) << second;
  EXPECT_EQ(desk.run("watch - --prometheus servodx.prom" + std::string(FleetDesk::judged_with)).code, 2);
}

TEST(Watch, PagesAreWrittenWhereAskedFor) {
  const WatchDesk desk;
  desk.write("in/one.csv", FleetDesk::excerpt("healthy/h04_multisine.csv"));
  ASSERT_EQ(desk.once("--pages").code, 0);
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(desk / "res"))
    pages += entry.path().extension() == ".html" && bytes_of(entry.path()).find("one.csv") != std::string::npos;
  EXPECT_EQ(pages, 1);
  EXPECT_EQ(desk.run("gather res").code, 0);
}

// Killed without warning after its first result, begun again, and told to end when all results are there.
TEST(Watch, AKilledWatchGoesOnFromItsResultsAndEndsCleanlyWhenTold) {
  const WatchDesk desk;
  constexpr int logs = 12;
  for (int k = 0; k < logs; ++k)
    desk.write("in/l" + std::to_string(k) + ".csv", FleetDesk::excerpt("healthy/h04_multisine.csv", 30 + k));
  const std::string watch =
      "'" + std::string(SERVODX_PROGRAM) + "' watch in --out res --settle 0 --interval 0.05" + FleetDesk::judged_with;
  const std::string results = "$(ls res 2>ls.err | grep -c 'json$')";
  desk.write("twice", "cd '" + desk.path.string() + "'\nset -m\n" + watch +
                          "--json first.json >out 2>&1 &\nuntil test " + results +
                          " -ge 1; do sleep 0.01; done\nkill -KILL $!\nwait $!\n" +
                          results.substr(2, results.size() - 3) + " >kept\n" + watch +
                          "--json second.json >out 2>&1 &\nuntil test " + results + " -ge " + std::to_string(logs) +
                          "; do sleep 0.01; done\ncp in/l0.csv late && mv late in/late.csv\nuntil test " + results +
                          " -ge " + std::to_string(logs + 1) + "; do sleep 0.01; done\nkill -TERM $!\nwait $!\n");
  const int status = std::system(("bash '" + (desk / "twice") + "'").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 0) << bytes_of(desk / "out");
  EXPECT_FALSE(std::filesystem::exists(desk / "first.json"));
  const Json second = Json::parse(bytes_of(desk / "second.json"));
  const int kept = std::stoi(bytes_of(desk / "kept"));
  EXPECT_GE(kept, 1);
  EXPECT_EQ(second["stood"], kept);
  EXPECT_EQ(second["judged"], logs + 1 - kept);
  EXPECT_EQ(desk.results("res").size(), static_cast<std::size_t>(logs + 1));
}

// A folder has no end of its own: to be told is how its watch ends, also in the middle of a judgement.
TEST(Watch, OfAFolderEndsCleanlyWhenToldWhileALogIsInWork) {
  const WatchDesk desk;
  constexpr int logs = 12;
  for (int k = 0; k < logs; ++k)
    desk.write("in/l" + std::to_string(k) + ".csv", FleetDesk::excerpt("healthy/h04_multisine.csv", 30 + k));
  desk.write("once", "cd '" + desk.path.string() + "'\nset -m\n'" + SERVODX_PROGRAM +
                         "' watch in --out res --settle 0 --interval 0.05" + FleetDesk::judged_with +
                         ">out 2>&1 &\nuntil test $(ls res 2>ls.err | grep -c 'json$') -ge 1; do sleep 0.01; done\n"
                         "kill -TERM $!\nwait $!\n");
  const int status = std::system(("bash '" + (desk / "once") + "'").c_str());
  EXPECT_EQ(WEXITSTATUS(status), 0) << bytes_of(desk / "out");
  EXPECT_LT(desk.results("res").size(), static_cast<std::size_t>(logs)) << "it ended before all were judged";
}

}  // namespace
}  // namespace servodx
