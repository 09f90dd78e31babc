// watch --follow FILE and watch -, as called: a log that grows, a pipe, a kill, an interrupt.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "cli/program.h"
#include "fleet.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

// A flight in which the feedback wire fractures at 2.5 s, watched by a table that is not quite this valve's.
struct FollowDesk : FleetDesk {
  static constexpr int rows = 2900;
  FollowDesk() {
    write("h.csv", excerpt("healthy/h10_flight.csv", 3000));
    write("whole.csv", excerpt("sudden/s01_wire_fractures.csv", rows));
  }
  static std::string with(const std::string& more) { return " --healthy h.csv " + more + judged_with; }
  static std::vector<Json> lines(const std::string& text) {
    std::vector<Json> out;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) out.push_back(Json::parse(line));
    return out;
  }
  // The last event of each number, without diagnoses: what a reader of events goes by.
  static std::map<long, Json> by_number(const std::vector<Json>& events) {
    std::map<long, Json> out;
    for (const Json& e : events)
      if (e["event"] != "diagnosis") out[e["number"]] = e;
    return out;
  }
};

TEST(Follow, AFractureInAGrowingLogIsAnAlarmInTime) {
  const FollowDesk desk;
  const Ended ended = desk.run("watch --follow whole.csv --until-idle 0.2 --json - " + FollowDesk::with(""));
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json result = Json::parse(ended.out);
  EXPECT_EQ(result["alarms"], 1) << result["events"];
  EXPECT_EQ(result["samples"]["taken"], FollowDesk::rows);
  ASSERT_FALSE(result["events"].empty());
  const Json& alarm = result["events"][0];
  EXPECT_EQ(alarm["event"], "alarm");
  EXPECT_GE(alarm["time"], 2.5);
  EXPECT_LT(alarm["told_at"], 2.6);
}

TEST(Follow, APipeGivesTheEventsOfTheFile) {
  const FollowDesk desk;
  const Ended file = desk.run("watch --follow whole.csv --until-idle 0.2 --events - " + FollowDesk::with(""));
  const Ended pipe = desk.run("watch - --events - <whole.csv " + FollowDesk::with(""));
  EXPECT_EQ(file.code, 0) << file.err;
  EXPECT_EQ(pipe.code, 0) << pipe.err;
  EXPECT_FALSE(file.out.empty());
  EXPECT_EQ(FollowDesk::by_number(FollowDesk::lines(file.out)), FollowDesk::by_number(FollowDesk::lines(pipe.out)));
}

TEST(Follow, ACallThatCannotBeMeantIsRefused) {
  const FollowDesk desk;
  const auto before = desk.contents();
  for (const char* call :
       {"watch ", "watch a --follow whole.csv ", "watch --follow whole.csv --out res ", "watch --follow none.csv ",
        "watch --follow whole.csv --until-idle -1 ", "watch --follow whole.csv --alarms-per-hour 0 "}) {
    EXPECT_EQ(desk.run(call + FollowDesk::with("")).code, 2) << call;
    EXPECT_EQ(desk.contents(), before) << call;
  }
}

// Runs the program in the background; its number.
int begin(const FollowDesk& desk, const std::string& arguments) {
  const std::string call = "cd '" + desk.path.string() + "' && { '" + SERVODX_PROGRAM + "' " + arguments +
                           " >/dev/null 2>&1 & echo $! >pid; }";
  if (std::system(call.c_str()) != 0) return 0;
  int pid = 0;
  std::ifstream(desk / "pid") >> pid;
  return pid;
}

// The state's `key` once `holds` says so, however long that takes; null where the program has ended.
template <class Holds>
Json wait_for(const FollowDesk& desk, int pid, const std::string& key, const Holds& holds) {
  while (is_alive(pid)) {
    const Json state = Json::parse(bytes_of(desk.path / "state.json"), nullptr, false);
    if (state.is_object() && holds(state[key])) return state[key];
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return {};
}

TEST(Follow, AKilledWatchGoesOnFromItsState) {
  const FollowDesk desk;
  const std::string whole = bytes_of(desk.path / "whole.csv");
  const Ended unbroken = desk.run("watch --follow whole.csv --until-idle 0.2 --events - " + FollowDesk::with(""));
  const std::size_t cut = whole.size() / 2;
  desk.write("log.csv", whole.substr(0, cut));
  const int pid = begin(desk, "watch --follow log.csv" + FollowDesk::with("--state state.json --events one.jsonl"));
  ASSERT_GT(pid, 0);
  ASSERT_FALSE(wait_for(desk, pid, "judged_until", [&](const Json& bytes) { return bytes >= cut * 9 / 10; }).is_null());
  kill(pid, SIGKILL);
  std::ofstream(desk / "log.csv", std::ios::app) << whole.substr(cut);
  const Ended second =
      desk.run("watch --follow log.csv --until-idle 0.2" + FollowDesk::with("--state state.json --events two.jsonl"));
  ASSERT_EQ(second.code, 0) << second.err;
  auto events = FollowDesk::lines(bytes_of(desk.path / "one.jsonl") + bytes_of(desk.path / "two.jsonl"));
  EXPECT_EQ(FollowDesk::by_number(events), FollowDesk::by_number(FollowDesk::lines(unbroken.out)));
}

TEST(Follow, ADiagnosisThatIsDueIsMadeAfterAKill) {
  FollowDesk desk;
  desk.write("whole.csv", excerpt("sudden/s01_wire_fractures.csv", 3700));
  const int pid = begin(desk, "watch --follow whole.csv" + FollowDesk::with("--state state.json --events one.jsonl"));
  ASSERT_GT(pid, 0);
  const Json due = wait_for(desk, pid, "due", [](const Json& made) { return !made.empty(); });
  kill(pid, SIGKILL);
  ASSERT_EQ(due.size(), 1u);
  ASSERT_EQ(bytes_of(desk.path / "one.jsonl").find("diagnosis"), std::string::npos);
  const Ended second =
      desk.run("watch --follow whole.csv --until-idle 0.2" + FollowDesk::with("--state state.json --events two.jsonl"));
  ASSERT_EQ(second.code, 0) << second.err;
  std::vector<Json> made;
  for (const Json& e : FollowDesk::lines(bytes_of(desk.path / "two.jsonl")))
    if (e["event"] == "diagnosis") made.push_back(e);
  ASSERT_EQ(made.size(), 1u);
  EXPECT_EQ(made[0]["number"], due[0][0]);
  EXPECT_TRUE(made[0].contains("result")) << made[0];
  EXPECT_TRUE(Json::parse(bytes_of(desk.path / "state.json"))["due"].empty());
}

TEST(Follow, AShorterLogUnderTheNameOfAStateIsWatchedFromItsBegin) {
  const FollowDesk desk;
  const std::string whole = bytes_of(desk.path / "whole.csv");
  desk.write("log.csv", whole);
  const auto watch = [&](const std::string& more) {
    const Ended ended = desk.run("watch --follow log.csv --until-idle 0.2 --json -" + FollowDesk::with(more));
    EXPECT_EQ(ended.code, 0) << ended.err;
    return Json::parse(ended.out);
  };
  EXPECT_EQ(watch("--state state.json")["samples"]["taken"], FollowDesk::rows);
  EXPECT_EQ(watch("--state state.json")["samples"]["taken"], FollowDesk::rows) << "none of them twice";
  desk.write("log.csv", whole.substr(0, whole.rfind('\n', whole.size() * 9 / 10) + 1));
  const Json anew = watch("--state state.json"), without = watch("");
  EXPECT_GT(without["samples"]["taken"], FollowDesk::rows / 2);
  for (const char* part : {"samples", "seconds_of_log", "events", "alarms"})
    EXPECT_EQ(anew[part], without[part]) << part;
}

TEST(Follow, StandardInputWithoutALogIsRefused) {
  const FollowDesk desk;
  const auto before = desk.contents();
  const Ended empty = desk.run("watch - --events e.jsonl </dev/null " + FollowDesk::with(""));
  EXPECT_EQ(empty.code, 2);
  EXPECT_NE(empty.err.find("no header row"), std::string::npos) << empty.err;
  EXPECT_EQ(desk.contents(), before);
}

TEST(Follow, AnInterruptEndsWith130AndItsStateWritten) {
  const FollowDesk desk;
  desk.write("interrupt", "cd '" + desk.path.string() + "'\nset -m\n'" + SERVODX_PROGRAM +
                              "' watch --follow whole.csv" + FollowDesk::with("--state state.json") +
                              " >words 2>&1 &\nwhile kill -0 $! && ! grep -Eq '\"judged_until\": ?[1-9]' state.json; " +
                              "do sleep 0.05; done 2>alive\nkill -INT $!\nwait $!\n");
  const int code = std::system(("bash '" + (desk / "interrupt") + "'").c_str());
  EXPECT_EQ(WEXITSTATUS(code), 130);
  EXPECT_GT(Json::parse(bytes_of(desk.path / "state.json"))["judged_until"], 0);
}

}  // namespace
}  // namespace servodx
