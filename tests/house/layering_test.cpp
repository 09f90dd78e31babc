// Dependencies point one way: who may include whom, directly. A pair that is not in this table is a wrong turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace {

namespace fs = std::filesystem;

// Every folder may use itself and base. `store` and `report` take the result structs of the folders named: the one
// reads them back, the other writes them. symbols_test.py asks that what a file names comes by its own includes: so the
// table is true of names too.
const std::map<std::string, std::set<std::string>> allowed = {
    {"base", {}},
    {"parameters", {}},
    {"model", {"parameters"}},
    {"effects", {"parameters", "model"}},
    {"faults", {"parameters", "model", "effects"}},
    {"integrate", {}},
    {"optimise", {}},
    {"signals", {}},
    {"valve_maps", {}},
    {"curves", {"signals"}},
    {"fleet", {"faults"}},
    {"simulate", {"parameters", "model", "effects", "faults", "integrate", "signals"}},
    {"rig", {"integrate", "signals"}},
    {"fit", {"parameters", "model", "effects", "simulate", "signals", "optimise"}},
    {"tune", {"parameters", "effects", "signals", "simulate", "optimise", "fit", "evidence"}},
    {"evidence", {"fit", "signals"}},
    // Of the model the temperatures that an oil bears.
    {"diagnose",
     {"parameters", "signals", "model", "simulate", "optimise", "fit", "tune", "evidence", "faults", "effects"}},
    {"explain", {"parameters", "signals", "simulate", "optimise", "fit", "tune", "evidence", "faults", "effects"}},
    {"plan",
     {"parameters", "signals", "simulate", "optimise", "fit", "tune", "evidence", "faults", "effects", "diagnose"}},
    {"online", {"parameters", "signals", "model", "simulate", "fit", "evidence", "diagnose", "faults"}},
    // Words are made of every outcome: of a row's verdict and of why a search stopped, too.
    {"report",
     {"parameters", "signals", "optimise", "faults", "diagnose", "explain", "evidence", "prognose", "fit", "tune",
      "valve_maps", "curves", "fleet", "plan", "store", "online"}},
    {"prognose", {"parameters", "signals", "model", "simulate", "optimise", "fit", "faults", "valve_maps"}},
    {"store",
     {"parameters", "signals", "model", "simulate", "faults", "evidence", "curves", "diagnose", "explain", "prognose"}},
    // The front door is made of everything below the program; of report its words and files.
    {"door", {"parameters", "signals",  "model",    "effects", "simulate", "fit",       "tune",
              "faults",     "evidence", "diagnose", "explain", "prognose", "store",     "report",
              "plan",       "online",   "optimise", "curves",  "fleet",    "valve_maps"}},
};

// The front door (include/servodx): each of its headers is the folder's whose options and results it declares. The
// calls themselves are made in src/door.
const std::map<std::string, std::string> door = {{"servodx/error.h", "base"},
                                                 {"servodx/trouble.h", "base"},
                                                 {"servodx/watch.h", "base"},
                                                 {"servodx/checkpoint.h", "base"},
                                                 {"servodx/note.h", "base"},
                                                 {"servodx/rig.h", "signals"},
                                                 {"servodx/log.h", "signals"},
                                                 {"servodx/join.h", "signals"},
                                                 {"servodx/table.h", "parameters"},
                                                 {"servodx/instruction_set.h", "simulate"},
                                                 {"servodx/maintenance.h", "faults"},
                                                 {"servodx/data_sheet.h", "fit"},
                                                 {"servodx/tuned_by.h", "fit"},
                                                 {"servodx/replay.h", "fit"},
                                                 {"servodx/bode.h", "fit"},
                                                 {"servodx/selftest.h", "fit"},
                                                 {"servodx/tune.h", "tune"},
                                                 {"servodx/sensitivity.h", "tune"},
                                                 {"servodx/operating_point.h", "evidence"},
                                                 {"servodx/actions.h", "diagnose"},
                                                 {"servodx/baseline.h", "diagnose"},
                                                 {"servodx/check_log.h", "diagnose"},
                                                 {"servodx/diagnose.h", "diagnose"},
                                                 {"servodx/explain.h", "explain"},
                                                 {"servodx/plan.h", "plan"},
                                                 {"servodx/monitor.h", "prognose"},
                                                 {"servodx/trend.h", "prognose"},
                                                 {"servodx/certificate.h", "store"},
                                                 {"servodx/history.h", "store"},
                                                 {"servodx/stepper.h", "online"},
                                                 {"servodx/curves.h", "curves"},
                                                 {"servodx/fleet.h", "fleet"},
                                                 {"servodx/map_points.h", "valve_maps"},
                                                 {"servodx/valve_numbers.h", "valve_maps"},
                                                 {"servodx/charts.h", "door"},
                                                 {"servodx/draft.h", "door"},
                                                 {"servodx/lists.h", "door"},
                                                 {"servodx/map.h", "door"},
                                                 {"servodx/miss.h", "door"},
                                                 {"servodx/objective.h", "door"},
                                                 {"servodx/pages.h", "door"},
                                                 {"servodx/simulate.h", "door"},
                                                 {"servodx/servodx.h", "door"}};

struct Include {
  std::string from, to;  // folders
  std::string file;
  long line;
  std::string text;
};

// The path of an `#include "..."` line, or nothing.
std::string quoted_include(std::string line) {
  std::erase_if(line, [](char c) { return c == ' ' || c == '\t'; });
  constexpr std::string_view start = "#include\"";
  if (!line.starts_with(start)) return {};
  return line.substr(start.size(), line.find('"', start.size()) - start.size());
}

// `relative`: the file's path below src.
std::vector<Include> includes_in(std::istream&& in, const std::string& relative) {
  const std::string from = relative.substr(0, relative.find('/'));
  std::vector<Include> found;
  long number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const std::string path = quoted_include(line);
    if (path.empty()) continue;
    const auto slash = path.find('/');
    found.push_back({from, slash == std::string::npos ? "" : path.substr(0, slash), "src/" + relative, number, path});
  }
  return found;
}

std::vector<Include> includes_of(const fs::path& file, const fs::path& src) {
  return includes_in(std::ifstream(file), fs::relative(file, src).generic_string());
}

bool is_allowed(const Include& include) {
  const auto owner = door.find(include.text);
  const std::string& to = owner == door.end() ? include.to : owner->second;
  if (to == include.from || to == "base") return true;
  const auto row = allowed.find(include.from);
  return row != allowed.end() && row->second.contains(to);
}

const fs::path src = fs::path(SERVODX_SOURCE_DIR) / "src";

// Why a file may not have this include; empty where it may.
std::string wrong_turn(const Include& include) {
  const std::string place = include.file + ":" + std::to_string(include.line) + ": ",
                    quoted = "\"" + include.text + "\"";
  if (include.to.empty()) return place + quoted + " has no folder; write \"" + include.from + "/" + include.text + "\"";
  const fs::path root = door.contains(include.text) ? src / "../include" : src;
  if (!fs::exists(root / include.text)) return place + quoted + " is not in src/";
  if (!is_allowed(include)) return place + include.from + " may not include " + include.to + " (" + quoted + ")";
  return "";
}

TEST(Layering, DirectIncludesFollowTheTable) {
  int seen = 0;
  for (const auto& entry : fs::recursive_directory_iterator(src)) {
    if (!entry.is_regular_file()) continue;
    for (const Include& include : includes_of(entry.path(), src)) {
      ++seen;
      EXPECT_EQ(wrong_turn(include), "");
    }
  }
  EXPECT_GT(seen, 10) << "no includes found under " << src;
}

TEST(Layering, AWrongTurnIsTold) {
  const auto told = [](const std::string& text, const std::string& file) {
    std::vector<std::string> out;
    for (const Include& include : includes_in(std::istringstream(text), file)) out.push_back(wrong_turn(include));
    return out;
  };
  EXPECT_EQ(told("#include <vector>\n# include \"model/state.h\"\n", "optimise/made_up.h"),
            std::vector<std::string>{"src/optimise/made_up.h:2: optimise may not include model (\"model/state.h\")"});
  EXPECT_EQ(
      told("#include \"servodx/explain.h\"\n#include \"error.h\"\n#include \"base/no_such.h\"\n", "tune/made_up.cpp"),
      (std::vector<std::string>{"src/tune/made_up.cpp:1: tune may not include servodx (\"servodx/explain.h\")",
                                "src/tune/made_up.cpp:2: \"error.h\" has no folder; write \"tune/error.h\"",
                                "src/tune/made_up.cpp:3: \"base/no_such.h\" is not in src/"}));
  EXPECT_EQ(told("#include \"base/sha256.h\"\n#include \"servodx/tune.h\"\n", "tune/made_up.cpp"),
            (std::vector<std::string>{"", ""}));
}

// What stands above the library: roots whose headers it may include, besides its own folder.
const std::map<std::string, std::vector<std::string>> above = {{"apps", {"include", "src"}},
                                                               {"bench", {"include", "src", "bench", "tests"}},
                                                               {"tests", {"include", "src", "tests", "bench"}},
                                                               {"examples", {"include"}},
                                                               {"python", {"include"}}};

TEST(Layering, ProgramBenchesTestsAndExamplesIncludeWhatTheyMay) {
  const fs::path root = SERVODX_SOURCE_DIR;
  for (const auto& [folder, roots] : above) {
    int seen = 0;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const auto kind = entry.path().extension();
      if (kind != ".h" && kind != ".cpp") continue;
      for (const Include& include : includes_of(entry.path(), root)) {
        ++seen;
        const bool own = fs::exists(entry.path().parent_path() / include.text);
        EXPECT_TRUE(own || std::any_of(roots.begin(), roots.end(),
                                       [&](const std::string& r) { return fs::exists(root / r / include.text); }))
            << entry.path() << ":" << include.line << ": " << folder << " may not include \"" << include.text << "\"";
      }
    }
    EXPECT_GT(seen, 0) << "no includes found under " << folder;
  }
}

// The program is written on the front door: that and the report, which makes words of what the door gives, are its two
// legs; base serves both. What a file of it may include besides, folder or header, and why.
struct Besides {
  std::set<std::string> what;
  std::string why;
};
const std::map<std::string, Besides> program_besides = {
    {"compare_command.cpp", {{"store/result_json.h"}, "results are read back as JSON, which the door does not hold"}},
    {"diagnose_command.cpp", {{"store/verdict_file.h"}, "the last test's verdict is read back as JSON"}},
    {"follow.cpp",
     {{"online", "signals/growing_log.h", "signals/sample.h"},
      "the watch of a log that grows is not on the door yet: its state is JSON"}},
    {"list_run.h",
     {{"fleet"}, "a run over a list and its folder of results are the program's own: fleet is base alone"}},
    {"result_folder.cpp", {{"fleet"}, "the same"}},
    {"fleet_judge.h", {{"fleet"}, "the same"}},
    {"fleet_judge.cpp", {{"fleet"}, "the same"}},
    {"diagnose_list.cpp", {{"fleet"}, "the same"}},
    {"check_list.cpp", {{"fleet"}, "the same"}},
    {"watch_command.cpp", {{"fleet"}, "the same, of a watched folder, and its gauges"}},
    {"list_command.cpp", {{"rig/excitations.h"}, "the virtual rig is a tool, and no part of the library"}},
    {"rig_command.cpp", {{"rig"}, "the same"}},
};

TEST(Layering, TheProgramStandsOnTheDoorAndTheReport) {
  const fs::path root = SERVODX_SOURCE_DIR, folder = root / "apps/servodx";
  const std::set<std::string> legs = {"servodx", "report", "base"};
  std::set<std::string> used;
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto kind = entry.path().extension();
    if (kind != ".h" && kind != ".cpp") continue;
    const std::string file = entry.path().filename().string();
    const auto besides = program_besides.find(file);
    for (const Include& include : includes_of(entry.path(), root)) {
      ++seen;
      if (legs.contains(include.to) || fs::exists(folder / include.text)) continue;
      const bool told = besides != program_besides.end() &&
                        (besides->second.what.contains(include.to) || besides->second.what.contains(include.text));
      EXPECT_TRUE(told) << file << ":" << include.line << ": the program may not include \"" << include.text
                        << "\": call the front door, or extend it";
      if (told) used.insert(file);
    }
  }
  EXPECT_GT(seen, 100);
  for (const auto& [file, excepted] : program_besides) {
    EXPECT_FALSE(excepted.why.empty()) << file;
    EXPECT_TRUE(used.contains(file)) << file << " needs no exception: take it off the list";
  }
}

// The rig that judges the program blind shares no equation with it.
TEST(Layering, TheForeignRigKnowsBaseAlone) {
  const fs::path root = SERVODX_SOURCE_DIR, folder = root / "bench/foreign";
  int seen = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const auto kind = entry.path().extension();
    if (kind != ".h" && kind != ".cpp") continue;
    for (const Include& include : includes_of(entry.path(), root)) {
      ++seen;
      EXPECT_TRUE(include.to == "base" || fs::exists(folder / include.text))
          << entry.path() << ":" << include.line << ": \"" << include.text << "\" is the program's";
    }
  }
  EXPECT_GT(seen, 10);
}

TEST(Layering, EveryFolderOfSrcHasARow) {
  for (const auto& entry : fs::directory_iterator(fs::path(SERVODX_SOURCE_DIR) / "src")) {
    EXPECT_TRUE(entry.is_directory()) << entry.path() << " stands outside the folders";
    EXPECT_TRUE(allowed.contains(entry.path().filename().string())) << entry.path() << " has no row in the table";
  }
}

// Takes away, again and again, the folders that use nothing that is left; a cycle stays.
std::map<std::string, std::set<std::string>> in_cycles(std::map<std::string, std::set<std::string>> left) {
  for (bool taken = true; taken;) {
    taken = false;
    for (auto row = left.begin(); row != left.end();) {
      const bool leaf = std::none_of(row->second.begin(), row->second.end(),
                                     [&](const std::string& used) { return left.contains(used); });
      if (leaf)
        row = left.erase(row), taken = true;
      else
        ++row;
    }
  }
  return left;
}

TEST(Layering, TheTableItselfHasNoCycle) {
  const auto left = in_cycles(allowed);
  EXPECT_TRUE(left.empty()) << "cycle through " << left.begin()->first;
  auto turned = allowed;
  turned["model"].insert("tune");
  EXPECT_TRUE(in_cycles(turned).contains("model")) << "a cycle is not told";
}

// A fit that is minimised past optimise/local.h would not end with Ceres.
TEST(Layering, FitsAreMinimisedThroughTheLocalStage) {
  int through = 0;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(SERVODX_SOURCE_DIR) / "src")) {
    if (entry.path().extension() != ".cpp" || entry.path().parent_path().filename() == "optimise") continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    EXPECT_EQ(text.find("minimise_least_squares("), std::string::npos) << entry.path();
    through += text.find("minimise_locally(") != std::string::npos;
  }
  EXPECT_GE(through, 7);  // tune, profile, selftest, diagnose, explain, check, track
}

TEST(Layering, TheModelKnowsNoEffectAndTheRigNoModel) {
  EXPECT_FALSE(allowed.at("model").contains("effects"));
  EXPECT_FALSE(allowed.at("rig").contains("model"));
  EXPECT_FALSE(allowed.at("rig").contains("parameters"));
}

}  // namespace
