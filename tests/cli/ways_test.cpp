// The ways in and out: check-log, init, compare, --dry-run, --report, manifest and rerun, completion and man.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "base/sha256.h"
#include "program.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

std::string shipped_log(const std::string& name) {
  return bytes_of(std::filesystem::path(SERVODX_SOURCE_DIR) / "data" / name);
}

// The first `rows` rows of a shipped log.
std::string first_rows(const std::string& name, int rows) {
  std::istringstream in(shipped_log(name));
  std::string text, line;
  for (int k = 0; k <= rows && std::getline(in, line);) {
    k += line.starts_with('#') ? 0 : 1;
    text += line + "\n";
  }
  return text;
}

std::vector<std::string> kinds(const Json& result, std::size_t log = 0) {
  std::vector<std::string> all;
  for (const Json& f : result["logs"][log]["suspicious"]) all.push_back(f["kind"]);
  return all;
}

bool has(const std::vector<std::string>& all, const std::string& one) {
  return std::find(all.begin(), all.end(), one) != all.end();
}

Json check(const Desk& desk, const std::string& call) {
  const Ended ended = desk.run("check-log " + call + " --json -");
  EXPECT_EQ(ended.code, 0) << ended.err;
  return ended.code == 0 ? Json::parse(ended.out) : Json();
}

TEST(CheckLog, FindsJitterGapsAndCold) {
  const Desk desk;
  std::istringstream in(first_rows("healthy/h12_mixed.csv", 1000));
  std::string jitter, gaps, line;
  for (long row = -1; std::getline(in, line);) {
    if (line.starts_with('#')) continue;
    if (++row == 0) {
      jitter = gaps = line + "\n";
      continue;
    }
    const double t = std::stod(line);
    const std::string rest = line.substr(line.find(','));
    jitter += std::to_string(t + (row % 4 == 1 ? 6.5e-4 : 0)) + rest + "\n";  // late stamps, no sample lost
    if (row % 100 > 2) gaps += line + "\n";
  }
  desk.write("clean.csv", first_rows("healthy/h12_mixed.csv", 1000));
  desk.write("jitter.csv", jitter);
  desk.write("gaps.csv", gaps);
  desk.write("cold.csv", first_rows("healthy/h08_preflight_cold.csv", 1000));
  EXPECT_TRUE(kinds(check(desk, "clean.csv")).empty()) << check(desk, "clean.csv")["logs"][0]["suspicious"];
  const Json jittered = check(desk, "jitter.csv");
  EXPECT_TRUE(has(kinds(jittered), "jitter"));
  EXPECT_FALSE(has(kinds(jittered), "gaps"));
  EXPECT_NEAR(jittered["logs"][0]["rate"].get<double>(), 1000, 1);
  const Json dropped = check(desk, "gaps.csv");
  EXPECT_TRUE(has(kinds(dropped), "gaps"));
  EXPECT_EQ(dropped["logs"][0]["gaps"], 9);
  EXPECT_EQ(dropped["logs"][0]["lost_samples"], 27);
  EXPECT_TRUE(has(kinds(check(desk, "cold.csv")), "temperature"));
}

// In the last line, in JSON and in the page's headline.
TEST(CheckLog, AnOperatingPointBeyondTheSheetIsNotNothing) {
  const Desk desk;
  desk.write("log.csv", first_rows("healthy/h12_mixed.csv", 1000));
  desk.write("rig.toml", "[supply]\npressure = \"300 bar\"\n");
  const Ended ended = desk.run("check-log log.csv --rig rig.toml --report page.html");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("  BEYOND: supply "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("  nothing else suspicious\n"), std::string::npos) << ended.out;
  EXPECT_EQ(ended.out.find("  nothing suspicious"), std::string::npos) << ended.out;
  EXPECT_TRUE(has(kinds(check(desk, "log.csv --rig rig.toml")), "beyond"));
  EXPECT_NE(bytes_of(desk / "page.html").find("Suspicious in log.csv: beyond"), std::string::npos);
  const Ended alone = desk.run("check-log log.csv");
  EXPECT_NE(alone.out.find("  nothing suspicious\n"), std::string::npos) << alone.out;
}

TEST(CheckLog, APartOfAFactIsToldInPerCent) {
  const Desk desk;
  desk.write("rig.toml", "[valve]\nrated_current = \"20 mA\"\n");
  std::string log = "time [s],command [% of rated],spool_position [mm]\n";
  for (int k = 0; k < 200; ++k) log += std::to_string(1e-3 * k) + (k % 50 < 25 ? ",-40,0.1\n" : ",60,-0.1\n");
  desk.write("log.csv", log);
  const Ended ended = desk.run("check-log log.csv --rig rig.toml");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto at = ended.out.find("  command ");
  ASSERT_NE(at, std::string::npos) << ended.out;
  const std::string line = ended.out.substr(at, ended.out.find('\n', at) - at);
  for (const char* words : {" -40 ", " 60 ", "% of rated"}) EXPECT_NE(line.find(words), std::string::npos) << line;
}

TEST(CheckLog, FindsASignThatIsTurned) {
  const Desk desk;
  desk.write("log.csv", first_rows("healthy/h12_mixed.csv", 1500));
  for (const char* signal : {"spool_position", "piston_position"}) {
    const std::string name = signal;
    desk.write("rig.toml", "[columns]\n" + name + " = { signal = \"" + name + "\", gain = \"-1\" }\n");
    const Json found = check(desk, "log.csv --rig rig.toml")["logs"][0]["suspicious"];
    ASSERT_EQ(found.size(), 1) << found;
    EXPECT_EQ(found[0]["kind"], "sign");
    EXPECT_NE(found[0]["text"].get<std::string>().find(name), std::string::npos) << found;
  }
}

// A column's name misspelt in the rig file, or another in this log, would else drop the signal without a word.
TEST(CheckLog, FindsASignalThatIsMappedAndNotThere) {
  const Desk desk;
  std::string log = first_rows("healthy/h12_mixed.csv", 500);
  desk.write("rig.toml", "[columns]\n\"P_a\" = { signal = \"pressure_a\", unit = \"bar\" }\n");
  desk.write("log.csv", log);  // under its own name it is there
  EXPECT_TRUE(kinds(check(desk, "log.csv --rig rig.toml")).empty());
  log.replace(log.find("pressure_a"), 10, "P_aa");
  desk.write("log.csv", log);
  const Json found = check(desk, "log.csv --rig rig.toml")["logs"][0]["suspicious"];
  ASSERT_TRUE(has(kinds(check(desk, "log.csv --rig rig.toml")), "columns")) << found;
  for (const Json& f : found)
    if (f["kind"] == "columns") {
      for (const char* words : {"column 'P_a'", "'pressure_a'", "line 2", "is it 'P_aa'?"})
        EXPECT_NE(f["text"].get<std::string>().find(words), std::string::npos) << words << " is not in " << f;
    }
}

// A sine of 1000 samples; what the spool does is the test's.
std::string sine_log(const std::string& step, const std::function<std::string(int)>& spool,
                     const std::string& supply = "207") {
  std::string text = "time [s],command [mA],spool_position [mm],supply_pressure [bar]\n";
  for (int k = 0; k < 1000; ++k)
    text += std::to_string(k) + step + "," + fmt::format("{:.4f}", 5 * std::sin(0.01 * k)) + "," + spool(k) + "," +
            supply + "\n";
  return text;
}

std::string follows(int k) { return fmt::format("{:.4f}", 0.2 * std::sin(0.01 * k)); }
std::string noise(int k) { return std::to_string(k * 7919 % 1013 * 1e-4); }
std::string nothing(int) { return "0.125"; }

TEST(CheckLog, FindsAClockOrASupplyInAnotherUnit) {
  const Desk desk;
  const auto found = [&](const std::string& log, const std::string& words) {
    desk.write("log.csv", log);
    const Json all = check(desk, "log.csv");
    for (const Json& f : all["logs"][0]["suspicious"])
      if (f["text"].get<std::string>().find(words) != std::string::npos) return true;
    return false;
  };
  const std::string slow = "too few to see a valve move", fast = "more than loggers take", days = "over a day",
                    pressure = "is the rig without pressure";
  const std::string good = sine_log("e-3", follows);
  for (const std::string& words : {slow, fast, days, pressure}) EXPECT_FALSE(found(good, words)) << words;
  EXPECT_TRUE(found(sine_log("", follows), slow));  // ms read as s; 1 Hz
  EXPECT_TRUE(found(sine_log("e-6", follows), fast));
  EXPECT_TRUE(found(sine_log("e300", follows), days));
  EXPECT_TRUE(found(sine_log("e-3", follows, "0"), pressure));
}

TEST(CheckLog, FindsALogInWhichNothingMovesOrNoiseIsAll) {
  const Desk desk;
  const auto found = [&](const std::string& log) {
    desk.write("log.csv", log);
    return has(kinds(check(desk, "log.csv")), "response");
  };
  EXPECT_FALSE(found(sine_log("e-3", follows)));
  EXPECT_TRUE(found(sine_log("e-3", nothing)));
  EXPECT_TRUE(found(sine_log("e-3", noise)));
}

TEST(CheckLog, FindsALogOfAnotherRateAmongOthers) {
  const Desk desk;
  for (const char* name : {"a.csv", "b.csv"})
    desk.write(name, first_rows(name[0] == 'a' ? "healthy/h12_mixed.csv" : "healthy/h04_multisine.csv", 500));
  std::istringstream in(first_rows("healthy/h06_sweep.csv", 500));
  std::string slow, line;
  for (long row = 0; std::getline(in, line);)
    if (line.starts_with('#') || row++ % 2 == 0) slow += line + "\n";
  desk.write("slow.csv", slow);
  const Json result = check(desk, "a.csv b.csv slow.csv");
  EXPECT_FALSE(has(kinds(result, 0), "rate"));
  EXPECT_TRUE(has(kinds(result, 2), "rate"));
}

TEST(CheckLog, SaysWhatALogCanShow) {
  const Desk desk;
  desk.write("moving.csv", first_rows("healthy/h12_mixed.csv", 1000));
  desk.write("table.csv", shipped_table());
  const Json log = check(desk, "moving.csv --params table.csv")["logs"][0];
  ASSERT_FALSE(log["identifiable"].empty());
  ASSERT_GE(log["visible_faults"].size(), 7u);
  for (const Json& fault : log["visible_faults"]) EXPECT_GE(fault["deviate_at_typical"].get<double>(), 0.0) << fault;
  EXPECT_FALSE(log["model_error_known"].get<bool>());
}

// A user's own names, units and separator.
std::string foreign_log() {
  std::istringstream in(first_rows("healthy/h12_mixed.csv", 400));
  std::string text = "Zeit (ms);Strom (mA);Schieberweg [um];Kolbenweg_mm;Druck A (bar);Druck B (bar);note\n", line;
  bool header = true;
  while (std::getline(in, line)) {
    if (line.starts_with('#')) continue;
    if (std::exchange(header, false)) continue;
    std::istringstream cells(line);
    std::vector<double> v;
    for (std::string cell; std::getline(cells, cell, ',');) v.push_back(std::stod(cell));
    std::ostringstream row;
    row << v[0] * 1e3 << ';' << v[1] << ';' << v[2] * 1e3 << ';' << v[3] << ';' << v[4] << ';' << v[5] << ";1\n";
    std::string made = row.str();
    std::replace(made.begin(), made.end(), '.', ',');
    text += made;
  }
  return text;
}

TEST(Init, AForeignLogReadsWithTheRigFileItWrites) {
  const Desk desk;
  desk.write("log.csv", foreign_log());
  const Ended made = desk.run("init log.csv -o rig.toml --table params.csv");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("the log reads with it: 400 samples"), std::string::npos) << made.out;
  const Json result = check(desk, "log.csv --rig rig.toml --params params.csv");
  std::vector<std::string> signals;
  for (const Json& c : result["logs"][0]["channels"]) signals.push_back(c["signal"]);
  EXPECT_EQ(signals,
            (std::vector<std::string>{"command", "spool_position", "piston_position", "pressure_a", "pressure_b"}));
  const Ended again = desk.run("init log.csv -o rig.toml --table other.csv");
  EXPECT_EQ(again.code, 2);  // it may hold the user's work
  EXPECT_FALSE(std::filesystem::exists(desk / "other.csv"));
}

TEST(DryRun, PrintsTheSettingsAndWritesNothing) {
  const Desk desk;
  desk.write("log.csv", small_log());
  desk.write("table.csv", shipped_table());
  const auto before = desk.contents();
  const Ended ended =
      desk.run("tune log.csv --params table.csv -o tuned.csv --generations 7 --json r.json --report r.html --dry-run");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(desk.contents(), before);
  for (const char* word : {"dry run", "generations", "7", "population", "log.csv", "tuned.csv", "r.html"})
    EXPECT_NE(ended.out.find(word), std::string::npos) << word << " is not in " << ended.out;
  EXPECT_EQ(desk.run("tune missing.csv --params table.csv -o tuned.csv --dry-run").code, 2);
}

// What the header does not say is asked for on the screen, not only in the file.
TEST(Init, AHeaderWithBytesThatTomlForbidsIsNamedSoThatItIsFound) {
  const Desk desk;
  desk.write("log.csv", replaced(replaced(small_log(), "command [mA]", "com\x7Fmand [mA]"), "spool", "sp\x01ool"));
  ASSERT_EQ(desk.run("init log.csv -o rig.toml --table params.csv").code, 0);
  const std::string rig = bytes_of(desk / "rig.toml");
  EXPECT_NE(rig.find("com\\u007Fmand"), std::string::npos) << rig;
  EXPECT_NE(rig.find("sp\\u0001ool"), std::string::npos) << rig;
  // The reader of rig files takes it: what it refuses is the log, if anything.
  const Ended checked = desk.run("check-log log.csv --rig rig.toml");
  EXPECT_EQ(checked.err.find("is not TOML"), std::string::npos) << checked.err;
}

TEST(Init, SaysWhatTheHeaderDoesNotSay) {
  const Desk desk;
  std::string log = first_rows("healthy/h12_mixed.csv", 100);
  const auto header = log.find("time [s]"), end = log.find('\n', header);
  desk.write("bare.csv", "Zeit,Strom,Schieber,Kolben,pA,pB,psupply,preturn,Last,Oel" + log.substr(end));
  const Ended bare = desk.run("init bare.csv -o bare.toml --table bare.params.csv");
  ASSERT_EQ(bare.code, 0) << bare.err;
  for (const char* asked : {"'Strom', taken for command: no unit in the header", "'pA', taken for pressure_a: no unit"})
    EXPECT_NE(bare.out.find(asked), std::string::npos) << bare.out;
  EXPECT_NE(bare.out.find("taken by the values: 'Zeit' in s"), std::string::npos) << bare.out;
  desk.write("recorder.csv", "Recorder 7\n" + log.substr(header));
  const Ended preamble = desk.run("init recorder.csv -o recorder.toml --table recorder.params.csv");
  ASSERT_EQ(preamble.code, 0) << preamble.err;
  EXPECT_NE(preamble.out.find("1 row of other text above it"), std::string::npos) << preamble.out;
  const Json looked = check(desk, "recorder.csv --rig recorder.toml");
  const Json& of_log = looked.at("logs").at(0);
  EXPECT_NE(of_log.at("notices").dump().find("1 row of other text above it"), std::string::npos) << of_log;
  EXPECT_EQ(of_log.at("suspicious").dump().find("other text"), std::string::npos) << of_log;
  desk.write("asked.toml", "[columns]\n# \"Druck\" = { signal = \"pressure_a\" }  # ? 63 to 84: is it?\n");
  const Ended asked = desk.run("check-log recorder.csv --rig asked.toml");
  EXPECT_NE(asked.out.find("1 question of 'servodx init' is open, line 2: until it is answered"), std::string::npos)
      << asked.out << asked.err;
  desk.write("units.csv", log.substr(header));
  EXPECT_EQ(desk.run("init units.csv -o units.toml --table units.params.csv").out.find("no unit"), std::string::npos);
}

// A table as `tune` writes it and a baseline made with it: what the commands that need both will read.
std::string tuned_table() {
  std::istringstream in(shipped_table());
  std::string text, line;
  for (bool header = true; std::getline(in, line);) {
    if (line.starts_with('#') || line.empty()) continue;
    text += line + (std::exchange(header, false) ? ",std_error\n" : ",\n");
  }
  return text;
}

std::string empty_baseline(const std::string& table) {
  Json base = Json::parse(R"({"command": "baseline", "threshold": 3, "adequacy_limit": 1, "null_limit": 0.05,
    "false_alarm": {"asked": 0.1, "promised": 0.25, "promised_95": 0.6, "logs": 3, "logs_needed": 9, "statement": ""},
    "scores": [{"log": "h.csv", "sha256": "1", "score": 1, "adequacy": 1, "gains": {}}]})");
  base["tuned_sha256"] = sha256_of_file(table);
  return base.dump();
}

// A command that takes the option and forgets it would write in earnest, a check even into a history.
TEST(DryRun, IsARehearsalWithEveryCommandThatTakesIt) {
  const Desk desk;
  desk.write("log.csv", small_log());
  const std::string table = tuned_table();
  desk.write("table.csv", table);
  desk.write("base.json", empty_baseline(desk / "table.csv"));
  desk.write("lives.csv", "valve,at [h],name,value,std_error\nV7,10,fidelity,1.1,0.01\n");
  desk.write("other.csv", small_log(240));
  desk.write("third.csv", small_log(260));
  std::filesystem::create_directory(desk / "results");
  desk.write("results/log.json", R"({"command": "diagnose", "log": "log.csv", "refused": {"file": "log.csv", "line": 2,
             "column": "", "rule": "ragged row", "mend": "mend it"}})");
  desk.write("a.json", R"({"tool": "servodx", "command": "tune"})");
  desk.write("rig.toml", "[valve]\nrated_current = \"20 mA\"\n");
  ASSERT_EQ(desk.run("history import lives.csv --history h.db").code, 0);
  ASSERT_EQ(desk.run("simulate log.csv --params table.csv -o sim.csv").code, 0);
  const std::map<std::string, std::string> calls = {
      {"simulate", "log.csv --params table.csv -o out.csv"},
      {"tune", "log.csv --params table.csv -o out.csv"},
      {"baseline", "log.csv other.csv third.csv --params table.csv -o out.json"},
      {"diagnose", "log.csv --params table.csv --baseline base.json"},
      {"gather", "results -o out.csv"},
      {"watch", "results --out results --once --params table.csv --baseline base.json"},
      {"explain", "log.csv --params table.csv -o out.csv"},
      {"monitor", "log.csv --params table.csv -o out.csv"},
      {"check", "log.csv --params table.csv --history h.db --valve V7 --at 20"},
      {"trend", "--history h.db --valve V7"},
      {"history show", "--history h.db"},
      {"history event", "overhauled --history h.db --valve V7 --at 20"},
      {"history export", "--history h.db -o out.csv"},
      {"history import", "lives.csv --history new.db"},
      {"history verify", "--history h.db"},
      {"plan", "--params table.csv --rig rig.toml --seconds 1 -o out.csv"},
      {"rig", "--rig-model " + std::string(SERVODX_SOURCE_DIR) + "/params/rigs/borello2009.toml -o out.csv"},
      {"curves", "log.csv --rig rig.toml --svg out.svg"},
      {"map", "--model C3 --params table.csv -o out.csv"},
      {"list", "faults"},
      {"check-log", "log.csv"},
      {"sensitivity", "log.csv --params table.csv"},
      {"selftest", "log.csv --params table.csv"},
      {"compare", "a.json a.json"},
      {"join", "log.csv other.csv -o out.csv"},
      {"init", "log.csv -o out.toml --table out.csv"},
      {"rerun", "sim.csv.manifest.json"}};
  const auto before = desk.contents();
  for (const auto& [command, rest] : calls) {
    const Ended ended = desk.run(command + " " + rest + " --json r.json --report r.html --dry-run");
    EXPECT_EQ(ended.code, 0) << command << ": " << ended.err;
    EXPECT_NE(ended.out.find(", dry run: "), std::string::npos) << command << " printed: " << ended.out;
    EXPECT_EQ(desk.contents(), before) << command;
  }
  // None is missing above: `history` has commands of its own, the other three no options.
  std::istringstream man(desk.run("man").out);
  for (std::string line; std::getline(man, line);) {
    if (!line.starts_with(".SS ")) continue;
    std::string command = line.substr(4);
    command.erase(std::remove(command.begin(), command.end(), '\\'), command.end());
    if (command != "history" && command != "completion" && command != "man" && command != "help") {
      EXPECT_TRUE(calls.contains(command)) << command;
    }
  }
}

struct Simulated : Desk {
  Simulated() {
    write("log.csv", small_log());
    write("table.csv", shipped_table());
    const Ended ended = run("simulate log.csv --params table.csv -o sim.csv --json sim.json --report sim.html");
    EXPECT_EQ(ended.code, 0) << ended.err;
  }
};

TEST(Rerun, ReproducesEveryBitOfEveryOutput) {
  const Simulated desk;
  const auto before = desk.contents();
  const Json manifest = Json::parse(bytes_of(desk / "sim.csv.manifest.json"));
  for (const char* key : {"version", "seed", "threads", "inputs", "settings", "outputs", "arguments"})
    EXPECT_TRUE(manifest.contains(key)) << key;
  EXPECT_EQ(manifest["outputs"].size(), 3u);
  const Ended again = desk.run("rerun sim.csv.manifest.json");
  EXPECT_EQ(again.code, 0) << again.err << again.out;
  EXPECT_NE(again.out.find("reproduced bit for bit"), std::string::npos) << again.out;
  EXPECT_EQ(desk.contents(), before);  // results that were there stay as they are

  std::filesystem::remove(desk / "sim.csv");
  EXPECT_EQ(desk.run("rerun sim.csv.manifest.json").code, 0);
  EXPECT_EQ(bytes_of(desk / "sim.csv"), before.at("sim.csv"));
  // From another folder too.
  std::filesystem::create_directory(desk / "elsewhere");
  EXPECT_EQ(desk.run("rerun ../" + (desk.path.filename() / "sim.csv.manifest.json").string()).code, 0);
}

TEST(Rerun, SaysWhereBitsDifferAndKeepsBoth) {
  const Simulated desk;
  const std::string changed = bytes_of(desk / "sim.csv") + "\n";
  const std::string manifest = bytes_of(desk / "sim.csv.manifest.json");
  Json other = Json::parse(manifest);
  other["outputs"][0]["sha256"] = std::string(64, '0');
  desk.write("other.manifest.json", other.dump());
  const Ended ended = desk.run("rerun other.manifest.json");
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.out.find("DIFFERS"), std::string::npos) << ended.out;
  EXPECT_TRUE(std::filesystem::exists(desk / "sim.csv.rerun"));
}

TEST(Rerun, SaysWhereAnotherInstructionSetMadeTheResult) {
  const Simulated desk;
  Json manifest = Json::parse(bytes_of(desk / "sim.csv.manifest.json"));
  EXPECT_EQ(desk.run("rerun sim.csv.manifest.json").out.find("made by"), std::string::npos);
  manifest["instruction_set"] = "none_such";
  desk.write("other.manifest.json", manifest.dump());
  EXPECT_NE(desk.run("rerun other.manifest.json").out.find("made by none_such"), std::string::npos);
  manifest.erase("instruction_set");  // as earlier versions wrote it
  desk.write("other.manifest.json", manifest.dump());
  EXPECT_EQ(desk.run("rerun other.manifest.json").code, 0);
}

TEST(Rerun, WhatTheManifestDoesNotListIsNeitherReproducedNorOverwritten) {
  const Simulated desk;
  Json manifest = Json::parse(bytes_of(desk / "sim.csv.manifest.json"));
  manifest["outputs"].erase(0);  // sim.csv
  manifest["outputs"].erase(0);  // sim.json
  desk.write("edited.manifest.json", manifest.dump());
  desk.write("sim.csv", "mine\n");
  desk.write("sim.json", "mine too\n");
  const Ended ended = desk.run("rerun edited.manifest.json");
  EXPECT_EQ(ended.code, 1);
  EXPECT_NE(ended.out.find("NOT reproduced"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("sim.csv is written and not in the manifest"), std::string::npos) << ended.out;
  EXPECT_EQ(bytes_of(desk / "sim.csv"), "mine\n");
  EXPECT_EQ(bytes_of(desk / "sim.json"), "mine too\n");
}

TEST(Rerun, RefusesChangedInputs) {
  const Simulated desk;
  desk.write("log.csv", small_log(240));
  const Ended ended = desk.run("rerun sim.csv.manifest.json");
  EXPECT_EQ(ended.code, 2);
  EXPECT_NE(ended.err.find("log.csv: has changed"), std::string::npos) << ended.err;
}

TEST(DryRun, TellsHowLongLogsOfManySamplesTake) {
  const Desk desk;
  desk.write("params.csv", shipped_table());
  std::string log = "time [s],command [mA],spool_position [mm]\n";
  for (int k = 0; k < 160000; ++k) log += std::to_string(5e-5 * k) + (k % 50 < 25 ? ",-4,0.1\n" : ",6,-0.1\n");
  desk.write("log.csv", log);
  const Ended ended = desk.run("tune log.csv --params params.csv -o tuned.csv --dry-run");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.err.find("tune: 160000 samples, 2 min 8 s to 10 min 40 s of one core"), std::string::npos)
      << ended.err;
  EXPECT_EQ(desk.run("tune log.csv --params params.csv -o tuned.csv --dry-run --quiet").err, "");
}

TEST(Compare, LongTextsAreCutAndRoundingIsNoDifference) {
  const Simulated desk;
  for (const auto& [name, value] : {std::pair("a.json", "1.0"), std::pair("b.json", "1.0000000000001")})
    desk.write(name, std::string(R"({"tool": "servodx", "command": "explain", "version": "1", "seed": 1, "why": ")") +
                         std::string(500, name[0]) + R"(", "rms": )" + value + "}");
  const Ended ended = desk.run("compare a.json b.json");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.out.find("rms"), std::string::npos) << ended.out;
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LT(line.size(), 160u) << line;
}

TEST(Compare, AUnitOrPathThatIsNoTextIsNone) {
  const Desk desk;
  desk.write("a.json", R"({"tool": "servodx", "command": "x", "inputs": [{"sha256": "1", "path": 7}],
                           "row": {"estimate": 1, "std_error": 0.1, "unit": 5}})");
  desk.write("b.json", R"({"tool": "servodx", "command": "x", "row": {"estimate": 2, "std_error": 0.1}})");
  const Ended ended = desk.run("compare a.json b.json");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("row"), std::string::npos) << ended.out;
}

TEST(Compare, TellsWhatDiffersAndWhatDoesNot) {
  const Simulated desk;
  const Ended same = desk.run("compare sim.json sim.json");
  EXPECT_EQ(same.code, 0) << same.err;
  EXPECT_NE(same.out.find("are the same"), std::string::npos) << same.out;
  desk.write("a.json", R"({"tool": "servodx", "command": "tune", "version": "1", "seed": 1,
    "parameters": [{"name": "spool_friction", "unit": "N", "estimate": 3.0, "std_error": 0.1},
                   {"name": "moving_mass", "unit": "kg", "estimate": 10.0, "std_error": 1.0}]})");
  desk.write("b.json", R"({"tool": "servodx", "command": "tune", "version": "1", "seed": 2,
    "parameters": [{"name": "spool_friction", "unit": "N", "estimate": 4.0, "std_error": 0.1},
                   {"name": "moving_mass", "unit": "kg", "estimate": 10.5, "std_error": 1.0}]})");
  const Ended ended = desk.run("compare a.json b.json --json -");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json result = Json::parse(ended.out);
  ASSERT_EQ(result["differences"].size(), 2u);
  EXPECT_TRUE(result["differences"][0]["matters"]);
  EXPECT_NEAR(result["differences"][0]["sigmas"], 1.0 / (0.1 * std::sqrt(2.0)), 1e-9);
  EXPECT_FALSE(result["differences"][1]["matters"]);
  EXPECT_EQ(result["conditions"].size(), 1u);
  EXPECT_EQ(desk.run("compare a.json sim.json").code, 2);  // of different commands

  // A change is of the size of the first, upwards with a plus.
  for (const auto& [name, value] : {std::pair("e.json", "-2.0"), std::pair("f.json", "1.0")})
    desk.write(name, std::string(R"({"tool": "servodx", "command": "x", "null": )") + value + "}");
  EXPECT_EQ(Json::parse(desk.run("compare e.json f.json --json -").out)["differences"][0]["change"], "+150 %");
  EXPECT_EQ(Json::parse(desk.run("compare f.json e.json --json -").out)["differences"][0]["change"], "-300 %");

  // Another verdict matters; another number without an error is told.
  for (const auto& [name, verdict] : {std::pair("c.json", "healthy"), std::pair("d.json", "fault")})
    desk.write(name, std::string(R"({"tool": "servodx", "command": "diagnose", "version": "1", "seed": 1, "results":
      [{"log": "s.csv", "error": )") +
                         (verdict[0] == 'h' ? "2" : "3") + R"(, "verdict": ")" + verdict + R"("}]})");
  const Ended verdicts = desk.run("compare c.json d.json --json -");
  ASSERT_EQ(verdicts.code, 0) << verdicts.err;
  int matter = 0;
  const Json differences = Json::parse(verdicts.out)["differences"];
  for (const Json& d : differences) matter += d["matters"].get<bool>();
  EXPECT_EQ(differences.size(), 2u) << differences;
  EXPECT_EQ(matter, 1) << differences;
}

TEST(Report, EveryCommandThatTakesTheCommonOptionsWritesOne) {
  const Simulated desk;
  EXPECT_EQ(desk.run("list faults --report list.html --json - >/dev/null").code, 0);
  EXPECT_EQ(desk.run("check-log log.csv --report check.html").code, 0);
  EXPECT_EQ(desk.run("compare sim.json sim.json --report compare.html").code, 0);
  for (const char* page : {"list.html", "check.html", "compare.html", "sim.html"}) {
    const std::string html = bytes_of(desk / page);
    EXPECT_TRUE(html.starts_with("<!DOCTYPE html>")) << page;
    EXPECT_NE(html.find("</html>"), std::string::npos) << page;
  }
}

TEST(Report, ALogNamedLikeAScriptIsText) {
  const Desk desk;
  const std::string name = "<script>alert(1)<_script>.csv";
  desk.write(name, small_log());
  const Ended ended = desk.run("check-log '" + name + "' --report page.html");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const std::string html = bytes_of(desk / "page.html");
  for (const char* markup : {"<script>alert", "<script&gt;alert", "<_script"})
    EXPECT_EQ(html.find(markup), std::string::npos) << markup;
}

TEST(Manual, NamesEveryCommandAndOption) {
  const Desk desk;
  const std::string man = desk.run("man").out, bash = desk.run("completion bash").out;
  EXPECT_TRUE(man.starts_with(".TH SERVODX 1")) << man.substr(0, 100);
  for (const char* command :
       {"tune", "baseline", "diagnose", "check-log", "compare", "rerun", "selftest", "init", "history event"}) {
    std::string in_man = command;
    if (const auto at = in_man.find('-'); at != std::string::npos) in_man.replace(at, 1, "\\-");
    EXPECT_NE(man.find(".SS " + in_man + "\n"), std::string::npos) << command;
    const std::string first = std::string(command).substr(0, std::string(command).find(' '));
    EXPECT_NE(bash.find(first + ") options="), std::string::npos) << command;
  }
  const std::string common = man.substr(man.find(".SH COMMON OPTIONS"));
  for (const char* option : {"\\-\\-json", "\\-\\-rig", "\\-\\-quiet"})
    EXPECT_NE(common.find(option), std::string::npos) << option;
  EXPECT_NE(bash.find("--false-alarm"), std::string::npos);
  EXPECT_NE(bash.find("--pool"), std::string::npos);
  for (const char* shell : {"zsh", "fish"}) EXPECT_FALSE(desk.run(std::string("completion ") + shell).out.empty());
  EXPECT_EQ(desk.run("completion tcsh").code, 2);
  EXPECT_EQ(std::system("command -v bash >/dev/null"), 0);
  desk.write("c.bash", bash);
  EXPECT_EQ(std::system(("bash -n '" + (desk / "c.bash") + "'").c_str()), 0);
}

TEST(Help, IsWhatTheOptionPrints) {
  const Desk desk;
  for (const char* command : {"", "diagnose", "check-log", "history", "history event"}) {
    const Ended asked = desk.run(std::string("help ") + command), option = desk.run(std::string(command) + " --help");
    EXPECT_EQ(asked.code, 0) << command << asked.err;
    EXPECT_EQ(asked.out, option.out) << command;
    EXPECT_FALSE(asked.out.empty());
  }
}

TEST(Help, RefusesAnUnknownCommandWithTheNearestNames) {
  const Desk desk;
  const Ended near = desk.run("help chek"), far = desk.run("help frobnicate"), part = desk.run("help history evnt");
  for (const Ended& ended : {near, far, part}) {
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.out, "");
    EXPECT_NE(ended.err.find("no command is called"), std::string::npos) << ended.err;
    EXPECT_NE(ended.err.find("'servodx help' lists what there is"), std::string::npos) << ended.err;
  }
  EXPECT_NE(near.err.find("did you mean 'check'?"), std::string::npos) << near.err;
  EXPECT_NE(part.err.find("did you mean 'event'?"), std::string::npos) << part.err;
  EXPECT_EQ(far.err.find("did you mean"), std::string::npos) << far.err;
}

// On an empty desk each fails for want of its files, never as a call. The manual has them all.
TEST(Help, ExamplesAreCallsThatTheProgramTakes) {
  const Desk desk;
  std::string man = desk.run("man").out;
  man.erase(std::remove(man.begin(), man.end(), '\\'), man.end());
  std::istringstream section(man.substr(man.find(".SH EXAMPLES")));
  int seen = 0;
  for (std::string line; std::getline(section, line) && !line.starts_with(".SH EXIT");) {
    if (!line.starts_with("servodx ")) continue;
    ++seen;
    const std::string call = line.substr(8), command = call.substr(0, call.find(' '));
    const Ended ended = desk.run(call + " --dry-run");
    EXPECT_EQ(ended.err.find("--help' lists what there is"), std::string::npos) << call << '\n' << ended.err;
    EXPECT_NE(desk.run("help " + command).out.find(line), std::string::npos) << line;
  }
  EXPECT_GT(seen, 15);
}

TEST(Completion, BashCompletesCommandsTheirPartsAndOptions) {
  const Desk desk;
  desk.write("c.bash", desk.run("completion bash").out);
  const auto completed = [&](const std::string& words, int at) {
    const std::string call = "cd '" + desk.path.string() + "' && bash -c 'source ./c.bash; COMP_WORDS=(servodx " +
                             words + "); COMP_CWORD=" + std::to_string(at) +
                             "; _servodx; echo \"${COMPREPLY[*]}\"' >said";
    EXPECT_EQ(std::system(call.c_str()), 0);
    const std::string said = bytes_of(desk / "said");
    return said.substr(0, said.find('\n'));
  };
  EXPECT_EQ(completed("diag", 1), "diagnose");
  EXPECT_EQ(completed("tune --gen", 2), "--generations");
  EXPECT_EQ(completed("history ex", 2), "export");
  EXPECT_EQ(completed("help gath", 2), "gather");
  EXPECT_EQ(completed("history export --hist", 3), "--history");
}

TEST(Selftest, StatesBiasAndCoverage) {
  const Desk desk;
  desk.write("log.csv", first_rows("healthy/h12_mixed.csv", 500));
  desk.write("table.csv", shipped_table());
  const Ended ended = desk.run("selftest log.csv --params table.csv --repeats 2 --json - --quiet");
  ASSERT_EQ(ended.code, 0) << ended.err;
  const Json result = Json::parse(ended.out);
  ASSERT_FALSE(result["parameters"].empty());
  for (const char* key : {"bias", "bias_sigmas", "rms", "std_error", "covered", "counted"})
    EXPECT_TRUE(result["parameters"][0].contains(key)) << key;
  EXPECT_TRUE(result["coverage"].contains("value"));
}

}  // namespace
}  // namespace servodx
