// monitor, check, trend and history as a user calls them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

std::string data(const std::string& name) {
  return bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / name);
}

// The shipped table with a column of errors: `check` asks for a tuned one.
std::string as_tuned() {
  std::istringstream in(shipped_table());
  std::string text, line;
  while (std::getline(in, line))
    text += line + (line.starts_with("#") ? "" : line.starts_with("id,") ? ",std_error" : ",") + "\n";
  return text;
}

class Prognosis : public testing::Test {
 protected:
  Prognosis() {
    desk.write("tuned.csv", as_tuned());
    desk.write("rig.toml", data("rig.toml"));
    desk.write("hot.csv", data("healthy/h09_preflight_hot.csv"));
    desk.write("flight.csv", data("healthy/h10_flight.csv"));
  }
  Json json(const std::string& name) const { return Json::parse(bytes_of(desk / name)); }
  Desk desk;
};

TEST_F(Prognosis, MonitorWritesItsRunAndItsSpeed) {
  const Ended ended = desk.run("monitor flight.csv --params tuned.csv --rig rig.toml -o sim.csv --json m.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(
      bytes_of(desk / "sim.csv").starts_with("time [s],spool_position [mm],piston_position [mm],load_pressure"));
  const Json m = json("m.json");
  EXPECT_GT(m["real_time_factor"], 100);
  EXPECT_GT(m["mean_error"]["value"], 0);
  EXPECT_EQ(desk.run("monitor flight.csv --params tuned.csv -o s.csv --model C5").code, 0);
  EXPECT_EQ(desk.run("monitor flight.csv --params tuned.csv -o t.csv --model nonesuch").code, 2);
}

TEST_F(Prognosis, AFolderOfExportsIsImportedFileByFileEachWholeAndEachOnce) {
  std::filesystem::create_directory(desk / "nodes");
  const std::string head = "valve,at [h],name,value,std_error\n";
  desk.write("nodes/a.csv", head + "V7,1,fidelity,0.9,0.01\nV7,2,fidelity,0.8,0.01\n");
  desk.write("nodes/b.csv", head + "V8,1,fidelity,0.9,0.01\nV8,two,fidelity,0.8,0.01\n");
  desk.write("nodes/c.csv", head + "V7,2,fidelity,0.8,0.01\nV9,3,fidelity,0.7,0.01\n");
  desk.write("nodes/half.csv.servodx-tmp", head);
  const std::string call = "history import nodes --history h.db --json i.json";
  Ended ended = desk.run(call + " --dry-run");
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_FALSE(std::filesystem::exists(desk / "h.db"));
  ended = desk.run(call);
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.err.find("nodes/b.csv"), std::string::npos) << ended.err;
  Json i = json("i.json");
  EXPECT_EQ(i["checks"], 3);
  EXPECT_EQ(i["present"], 1);
  EXPECT_EQ(i["files"], 3);
  ASSERT_EQ(i["set_aside"].size(), 1u);
  EXPECT_EQ(i["set_aside"][0]["file"], "nodes/b.csv");
  ASSERT_EQ(desk.run("history show --history h.db --json s.json").code, 0);
  std::vector<std::string> valves;
  const Json shown = json("s.json");
  for (const Json& v : shown["valves"]) valves.push_back(v["valve"]);
  EXPECT_EQ(valves, (std::vector<std::string>{"V7", "V9"}));  // of b.csv nothing, not even its good row

  desk.write("nodes/b.csv", head + "V8,1,fidelity,0.9,0.01\n");
  ended = desk.run(call);
  EXPECT_EQ(ended.code, 0) << ended.err;
  i = json("i.json");
  EXPECT_EQ(i["checks"], 1);
  EXPECT_EQ(i["present"], 4);
  std::filesystem::create_directory(desk / "nothing");
  EXPECT_EQ(desk.run("history import nothing --history h.db").code, 2);
}

TEST_F(Prognosis, PrometheusIsToldOfEveryValvesLife) {
  std::string life = "valve,at [h],name,value,std_error\n";
  for (int k = 0; k < 40; ++k)
    life += fmt::format("V7,{},parameter:22,{},1e-7\nV8,{},parameter:22,3e-6,1e-7\n", 10 * k,
                        3e-6 + 4e-8 * std::pow(std::max(0, k - 15), 1.5), 10 * k);
  desk.write("life.csv", life);
  ASSERT_EQ(desk.run("history import life.csv --history h.db").code, 0);
  const Ended ended = desk.run("trend --history h.db --all --prometheus life.prom --json t.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string text = bytes_of(desk / "life.prom");
  for (const char* line : {"servodx_valve_state{valve=\"V7\",state=", "servodx_valve_state{valve=\"V8\",state=",
                           "servodx_valve_life_left_hours{valve=\"V7\",bound=\"median\"} "})
    EXPECT_NE(text.find(line), std::string::npos) << line << "\n" << text;
  EXPECT_EQ(desk.run("trend --history h.db --all --prometheus h.db").code, 2);
}

TEST_F(Prognosis, ACheckIsStoredOnceAndComesOutAsItWentIn) {
  const std::string call = "check hot.csv --params tuned.csv --rig rig.toml --history h.db --valve V7 --at ";
  const Ended ended = desk.run(call + "12.5 --json c.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json c = json("c.json");
  std::vector<std::string> names;
  for (const Json& check : c["checks"]) {
    names.push_back(check["name"]);
    for (const char* key : {"value", "std_error", "unit", "temperature"}) EXPECT_TRUE(check.contains(key)) << key;
  }
  for (const char* name : {"mean_error", "fidelity", "correlation@5Hz", "parameter:1", "parameter:9"})
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  for (const Json& check : c["checks"]) {
    // The monitor's missing lags are taken out, and a fitted row says what it may be off by.
    if (check["name"] == "fidelity") {
      EXPECT_LT(check["value"].get<double>() * check["expected"].get<double>(), 0.95 * check["measured"].get<double>());
    }
    if (check["name"].get<std::string>().starts_with("parameter:")) {
      EXPECT_GE(check["whole_error"], check["std_error"]) << check;
      EXPECT_TRUE(check["told"].is_boolean()) << check;
    }
  }
  EXPECT_EQ(desk.run(call + "12.5").code, 2);  // the same log at the same hours
  EXPECT_EQ(desk.run(call + "-1").code, 2);
  ASSERT_EQ(desk.run("history export --history h.db -o h.csv").code, 0);
  ASSERT_EQ(desk.run("history import h.csv --history other.db").code, 0);
  ASSERT_EQ(desk.run("history export --history other.db -o again.csv").code, 0);
  EXPECT_EQ(bytes_of(desk / "h.csv"), bytes_of(desk / "again.csv"));
  EXPECT_EQ(desk.run("history event nonesuch --valve V7 --at 13 --history h.db").code, 2);
  EXPECT_EQ(desk.run("history event filter_changed --valve V8 --at 13 --history h.db").code, 2);
  EXPECT_EQ(desk.run("history event filter_changed --valve V7 --at 13 --history h.db").code, 0);
  EXPECT_EQ(desk.run("history verify --history h.db").code, 0);
}

TEST_F(Prognosis, TrendOfFewChecksSaysSoAndRefusesWhatIsNotThere) {
  ASSERT_EQ(
      desk.run("check hot.csv --params tuned.csv --rig rig.toml --history h.db --valve V7 --at 1 --no-track").code, 0);
  ASSERT_EQ(desk.run("trend --history h.db --valve V7 --json t.json").code, 0);
  EXPECT_EQ(json("t.json")["state"], "unknown");
  ASSERT_EQ(desk.run("trend --history h.db --all --json a.json").code, 0);
  EXPECT_EQ(json("a.json")["valves"].size(), 1u);
  EXPECT_EQ(desk.run("trend --history h.db --valve V8").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db").code, 2);
  EXPECT_EQ(desk.run("trend --history none.db --all").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure fidelity").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure 'parameter:14=<20x'").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure 'parameter:14=20x~'").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure 'parameter:14=20x~1'").code, 0);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure parameter:9=0.9e-3A").code, 2);
  EXPECT_EQ(desk.run("trend --history h.db --valve V7 --failure parameter:14=0.9e-3A~2e-5").code, 0);
  EXPECT_FALSE(std::filesystem::exists(desk / "none.db"));
  for (const char* level : {"fidelty=1.7", "parameter:99=1", "parameter:9=-5"})
    EXPECT_EQ(desk.run(fmt::format("trend --history h.db --valve V7 --failure {}", level)).code, 2) << level;
}

TEST_F(Prognosis, NothingWritesOverTheHistoryNorStoresWhereTheResultCannotGo) {
  ASSERT_EQ(
      desk.run("check hot.csv --params tuned.csv --rig rig.toml --history h.db --valve V7 --at 1 --no-track").code, 0);
  for (const char* call : {"trend --history h.db --all", "history show --history h.db", "history verify --history h.db",
                           "history event note --history h.db --valve V7 --at 2"})
    for (const char* over : {"--json h.db", "--report h.db", "--json nowhere/x.json"})
      EXPECT_EQ(desk.run(fmt::format("{} {}", call, over)).code, 2) << call << " " << over;
  ASSERT_EQ(desk.run("history show --history h.db --json s.json").code, 0);
  EXPECT_EQ(json("s.json")["valves"][0]["checks"], 1);
  EXPECT_TRUE(json("s.json")["valves"][0]["events"].empty());
}

TEST_F(Prognosis, ACheckFillsAHistoryThatIsEmpty) {
  desk.write("h.db", "");
  EXPECT_EQ(
      desk.run("check hot.csv --params tuned.csv --rig rig.toml --history h.db --valve V7 --at 1 --no-track").code, 0);
  EXPECT_EQ(desk.run("history verify --history h.db").code, 0);
}

TEST_F(Prognosis, AnotherSerialOfOneValveIsTold) {
  const std::string check = "check hot.csv --params tuned.csv --rig rig.toml --history h.db --valve V7 --no-track ";
  const auto told = [&](const std::string& call) {
    const Ended ended = desk.run(check + call);
    EXPECT_EQ(ended.code, 0);
    return (ended.out + ended.err).find("valve_swapped") != std::string::npos;
  };
  EXPECT_FALSE(told("--at 1 --serial A"));
  EXPECT_FALSE(told("--at 2 --serial A"));
  EXPECT_TRUE(told("--at 3 --serial B"));
}

TEST_F(Prognosis, MonitorIsMadeAgainBitForBit) {
  ASSERT_EQ(desk.run("monitor flight.csv --params tuned.csv -o again.csv --json again.json --report again.html").code,
            0);
  EXPECT_EQ(desk.run("rerun again.csv.manifest.json").code, 0);
}

}  // namespace
}  // namespace servodx
