// The front door and the program are one: the same bytes, verdicts and refusals, on short excerpts of the shipped logs.
#include "cli/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include "servodx/servodx.h"

namespace servodx {
namespace {

using Json = nlohmann::json;

// What measures this machine.
std::string without_seconds(const std::string& text) {
  return std::regex_replace(text, std::regex("\"seconds\": [-+.0-9e]+"), "\"seconds\": 0");
}

// What the program has made of the desk's files, once in a process; the door reads them by the same relative paths.
class Door : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    desk = std::make_unique<Desk>();
    write_rig_and_baseline_logs(*desk);
    desk->write("t.csv", excerpt("healthy/h12_mixed.csv", 700));
    desk->write("s.csv", excerpt("fault/f02_clogged_filter_severe.csv", 300));
    ran("tune t.csv --params table.csv --generations 0 --rounds 1 --effects none -o tuned.csv");
    ran("baseline b1.csv b2.csv b3.csv --params tuned.csv --false-alarm 0.3 -o base.json");
    was = std::filesystem::current_path();
    std::filesystem::current_path(desk->path);
  }
  static void TearDownTestSuite() {
    std::filesystem::current_path(was);
    desk.reset();
  }
  static void ran(const std::string& call) {
    const Ended ended = desk->run(call + " --rig rig.toml --quiet");
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  static std::vector<Log> logs(const std::vector<std::string>& names) {
    std::vector<Log> out;
    for (const std::string& name : names) out.push_back(read_log(name, rig()));
    return out;
  }
  static Rig rig() { return read_rig_file("rig.toml"); }
  static Tuned quickly_tuned(Watch watch = {}) {
    TuneOptions options;
    options.generations = 0, options.rounds = 1, options.effects.emplace();
    options.watch = std::move(watch);
    return tune(logs({"t.csv"}), read_table("table.csv"), rig(), options);
  }
  static inline std::unique_ptr<Desk> desk;
  static inline std::filesystem::path was;
};

TEST_F(Door, WritesTheProgramsTableAndBaselineByteForByte) {
  const Tuned tuned = quickly_tuned();
  write_tuned("door.csv", tuned);
  EXPECT_EQ(bytes_of("door.csv"), bytes_of("tuned.csv"));
  EXPECT_EQ(tuned.table.sha256, read_tuned("tuned.csv").table.sha256);
  const Baseline baseline = make_baseline(logs({"b1.csv", "b2.csv", "b3.csv"}), read_tuned("tuned.csv"), rig(),
                                          {.false_alarm = 0.3, .others = logs({"t.csv"}), .threads = 1});
  write_baseline("door.json", baseline);
  EXPECT_EQ(without_seconds(bytes_of("door.json")), without_seconds(bytes_of("base.json")));
  write_baseline("again.json", read_baseline("base.json"));
  EXPECT_EQ(bytes_of("again.json"), bytes_of("base.json"));
}

TEST_F(Door, JudgesAsTheProgramDoes) {
  ran("diagnose s.csv --params tuned.csv --baseline base.json --json verdict.json");
  const Json of_program = Json::parse(bytes_of("verdict.json")).at("results").at(0);
  const Verdict v = diagnose(read_log("s.csv", rig()), read_tuned("tuned.csv"), rig(), read_baseline("base.json"));
  EXPECT_EQ(name_of(v.kind), of_program.at("verdict"));
  EXPECT_EQ(v.fault, of_program.at("fault").is_null() ? "" : of_program.at("fault"));
  EXPECT_EQ(v.error, of_program.at("error"));
  EXPECT_EQ(v.threshold, of_program.at("threshold"));
  EXPECT_EQ(v.p_value, of_program.at("p_value"));
  EXPECT_EQ(Json(v.probabilities), of_program.at("probabilities"));
  EXPECT_EQ(Json(v.ambiguous_with), of_program.at("ambiguous_with"));
  EXPECT_EQ(v.action, of_program.at("action"));
  ASSERT_EQ(v.severity.has_value(), !v.fault.empty());
  if (v.severity) {
    EXPECT_EQ(v.severity->value, of_program.at("severity").at("value"));
    EXPECT_EQ(v.severity->lower, of_program.at("severity").at("lower"));
    EXPECT_EQ(v.severity->unit, of_program.at("severity").at("unit"));
  }
  EXPECT_EQ(v.parameters.size(), of_program.at("parameters").size());
  EXPECT_EQ(Json::parse(json_of(v)), of_program);
}

TEST_F(Door, TwoCallsAtOnceDisturbNeither) {
  const Tuned tuned = read_tuned("tuned.csv");
  const Baseline baseline = read_baseline("base.json");
  const std::vector<Log> both = logs({"s.csv", "b1.csv"});
  std::vector<Verdict> alone, together(2);
  for (const Log& log : both) alone.push_back(diagnose(log, tuned, rig(), baseline));
  std::vector<std::thread> calls;
  for (std::size_t i = 0; i < 2; ++i)
    calls.emplace_back([&, i] { together[i] = diagnose(both[i], tuned, rig(), baseline); });
  for (std::thread& call : calls) call.join();
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(together[i].error, alone[i].error) << both[i].path;
    EXPECT_EQ(together[i].probabilities, alone[i].probabilities) << both[i].path;
  }
}

TEST_F(Door, ExplainsAsTheProgramDoes) {
  ran("explain s.csv --params tuned.csv --baseline base.json -o extended.csv --json explained.json");
  const Json of_program = Json::parse(bytes_of("explained.json"));
  const Explanation e =
      explain(logs({"s.csv"}), read_tuned("tuned.csv"), rig(), read_baseline("base.json"), ExplainOptions{});
  EXPECT_EQ(name_of(e.kind), of_program.at("verdict"));
  EXPECT_EQ(e.causes.size(), of_program.at("causes").size());
  EXPECT_EQ(e.candidates.size(), of_program.at("candidates").size());
  EXPECT_EQ(e.probabilities.contains("nothing"), !of_program.at("probabilities").is_null());
  const Json as_json = Json::parse(json_of(e));
  for (const auto& [key, value] : as_json.items()) EXPECT_EQ(value, of_program.at(key)) << key;
  write_table("door_extended.csv", e.table);
  EXPECT_EQ(bytes_of("door_extended.csv"), bytes_of("extended.csv"));
}

TEST_F(Door, SimulatesAsTheProgramDoes) {
  ran("simulate s.csv --params table.csv -o simulated.csv");
  const Log log = read_log("s.csv", rig());
  const Simulation simulation = simulate(log, read_table("table.csv"), rig());
  write_simulation("door_simulated.csv", log, simulation);
  EXPECT_EQ(bytes_of("door_simulated.csv"), bytes_of("simulated.csv"));
  ASSERT_NE(simulation.find(Signal::spool_position), nullptr);
  EXPECT_EQ(simulation.find(Signal::spool_position)->value.size(), log.samples());
  EXPECT_EQ(simulation.find(Signal::leakage_flow), nullptr);
}

TEST_F(Door, ChecksAndTrendsAsTheProgramDoes) {
  ran("check s.csv --params tuned.csv --history program.db --valve V --at 100 --json check.json");
  const Tuned tuned = read_tuned("tuned.csv");
  std::vector<double> parts;
  CheckOptions watched;
  watched.watch.progress = [&](const WorkDone& done) { parts.push_back(done.part); };
  const Checked checked = check(read_log("s.csv", rig()), tuned, rig(), watched);
  EXPECT_GT(parts.size(), 3u) << "a call of seconds shows that it works";
  EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
  EXPECT_EQ(parts.back(), 1);
  CheckOptions ended;
  ended.watch.stop = [] { return true; };
  const Checked stopped = check(read_log("s.csv", rig()), tuned, rig(), ended);
  EXPECT_TRUE(stopped.interrupted && stopped.figures.empty());
  EXPECT_FALSE(checked.interrupted);
  EXPECT_THROW(History::open_or_make("stopped.db").record("V", {.at = 100}, stopped, tuned), InputError);
  const Json of_program = Json::parse(bytes_of("check.json")).at("checks");
  ASSERT_EQ(checked.figures.size(), of_program.size());
  for (std::size_t i = 0; i < checked.figures.size(); ++i) {
    EXPECT_EQ(checked.figures[i].name, of_program[i].at("name"));
    EXPECT_EQ(checked.figures[i].value, of_program[i].at("value"));
  }
  History history = History::open_or_make("door.db");
  history.record("V", {.at = 100, .serial = rig().serial}, checked, tuned);
  history.add_event("V", 150, "filter_changed");
  EXPECT_EQ(history.valves(), std::vector<std::string>{"V"});
  ASSERT_EQ(events_of(history, "V").size(), 1u);
  EXPECT_EQ(events_of(history, "V").front().kind, EventKind::filter_changed);
  EXPECT_FALSE(history.tracked("V").empty());
  EXPECT_THROW(history.add_event("V", 150, "no_such_event"), InputError);
  EXPECT_THROW(History::open("nowhere.db"), InputError);
  ran("history event filter_changed --valve V --at 150 --history program.db");
  ran("trend --history program.db --valve V --json trend.json");
  const Trend found = trend(History::open("door.db"), "V");
  EXPECT_EQ(name_of(found.state), Json::parse(bytes_of("trend.json")).at("state"));
  EXPECT_EQ(found.checks, 1u);
  EXPECT_FALSE(found.trends.empty());
  TrendOptions at_once;
  at_once.watch.stop = [] { return true; };
  const Trend none = trend(History::open("door.db"), "V", at_once);
  EXPECT_TRUE(none.trends.empty());
  ASSERT_FALSE(none.notes.empty());
  EXPECT_EQ(none.notes.back().kind, Note::Kind::interrupted);
  EXPECT_THROW(trend(history, "W"), InputError);
}

TEST_F(Door, RefusesABaselineOfAnotherTableInTheProgramsWords) {
  Tuned other = read_tuned("tuned.csv");
  other.table.rows[static_cast<std::size_t>(other.table.find("port_width"))].nominal *= 1.01;
  write_tuned("other.csv", other);
  other = read_tuned("other.csv");
  const Baseline baseline = read_baseline("base.json");
  const Log log = read_log("s.csv", rig());
  EXPECT_NO_THROW(require_same_table(baseline, read_tuned("tuned.csv")));
  const Ended ended = desk->run("diagnose s.csv --rig rig.toml --params other.csv --baseline base.json");
  try {
    diagnose(log, other, rig(), baseline);
    ADD_FAILURE() << "a verdict by another table's threshold";
  } catch (const InputError& error) {
    EXPECT_NE(ended.err.find(error.what()), std::string::npos) << ended.err;
    EXPECT_NE(std::string(error.what()).find("was made with another table than other.csv"), std::string::npos);
  }
  EXPECT_THROW(explain({log}, other, rig(), baseline, ExplainOptions{}), InputError);
  EXPECT_THROW(diagnose_window(log, other, rig(), baseline), InputError);
}

// Of no table, and of an effect that is not freed.
TEST_F(Door, RefusesToProfileARowThatIsNotThereInTheProgramsWords) {
  for (const std::string row : {"port_witdh", "stiction_force"}) {
    TuneOptions options;
    options.effects.emplace(), options.profile = {row};
    const std::string call = "tune t.csv --rig rig.toml --params table.csv -o t.out --effects none --profile " + row;
    for (const std::string rehearsal : {"", " --dry-run"}) {
      const Ended ended = desk->run(call + rehearsal);
      EXPECT_EQ(ended.code, 2) << row << rehearsal;
      try {
        tune(logs({"t.csv"}), read_table("table.csv"), rig(), options);
        ADD_FAILURE() << row << " is taken";
      } catch (const InputError& error) {
        EXPECT_NE(ended.err.find(error.what()), std::string::npos) << ended.err;
        EXPECT_EQ(error.rule, "the table has no row '" + row + "'");
      }
    }
  }
}

TEST_F(Door, ABaselineKnowsItsOwnLogsByTheirSamples) {
  const auto is_own = [](const Baseline& baseline, const Log& log) {
    const std::vector<Note> notes = notes_beside(baseline, rig(), {log});
    return std::any_of(notes.begin(), notes.end(), [](const Note& n) { return n.kind == Note::Kind::own_log; });
  };
  desk->write("again.csv", "# the same samples\n" + bytes_of("b1.csv"));
  const Log own = read_log("b1.csv", rig()), again = read_log("again.csv", rig()), other = read_log("s.csv", rig());
  ASSERT_NE(own.sha256, again.sha256);
  const Baseline baseline = read_baseline("base.json");
  EXPECT_EQ(baseline.scores.front().content, content_hash(own));
  EXPECT_TRUE(is_own(baseline, own));
  EXPECT_TRUE(is_own(baseline, again));
  EXPECT_FALSE(is_own(baseline, other));

  Json old = Json::parse(bytes_of("base.json"));
  for (Json& score : old["scores"]) score.erase("content");
  desk->write("by_bytes.json", old.dump());
  const Baseline earlier = read_baseline("by_bytes.json");
  EXPECT_TRUE(is_own(earlier, own));
  EXPECT_FALSE(is_own(earlier, again)) << "an earlier version kept the hash of the file alone";
}

Row& width_of(Table& table) { return table.rows[static_cast<std::size_t>(table.find("port_width"))]; }

TEST_F(Door, ACommentIsNoOtherTableAndARowChangedInMemoryIs) {
  const Baseline baseline = read_baseline("base.json");
  const std::string text = bytes_of("tuned.csv");
  desk->write("commented.csv", "# looked over on the bench\n" + text);
  const Tuned commented = read_tuned("commented.csv");
  EXPECT_NE(commented.table.sha256, read_tuned("tuned.csv").table.sha256);
  EXPECT_FALSE(require_same_table(baseline, commented)) << "nothing to note";
  const Verdict plain = diagnose(read_log("s.csv", rig()), commented, rig(), baseline);
  EXPECT_EQ(json_of(plain), json_of(diagnose(read_log("s.csv", rig()), read_tuned("tuned.csv"), rig(), baseline)));

  for (const auto& change : std::vector<std::function<void(Table&)>>{
           [](Table& t) { width_of(t).nominal *= 1.001; }, [](Table& t) { width_of(t).upper *= 2; },
           [](Table& t) { t.state.replace(t.state.find("per_activity = "), 15, "per_activity = 1"); },
           [](Table& t) { t.rows.push_back(t.rows.back()), t.rows.back().group = "effect:seal_film"; }}) {
    Tuned other = read_tuned("tuned.csv");
    change(other.table);
    EXPECT_THROW(require_same_table(baseline, other), InputError);
  }
}

TEST_F(Door, ABaselineBoundToTheBytesOfItsTableIsReadWithANote) {
  Json old = Json::parse(bytes_of("base.json"));
  old["tuned_sha256"] = read_tuned("tuned.csv").table.sha256;
  desk->write("old.json", old.dump());
  const Baseline baseline = read_baseline("old.json");
  const auto note = require_same_table(baseline, read_tuned("tuned.csv"));
  ASSERT_TRUE(note);
  EXPECT_EQ(note->kind, Note::Kind::earlier_version);
  EXPECT_NE(note->text.find("old.json: a baseline of an earlier version"), std::string::npos) << note->text;
  const Verdict verdict = diagnose(read_log("s.csv", rig()), read_tuned("tuned.csv"), rig(), baseline);
  EXPECT_EQ(std::count(verdict.notes.begin(), verdict.notes.end(), *note), 1);
  old.erase("schema");
  desk->write("older.json", old.dump());
  const std::vector<Note> of_file = read_baseline("older.json").notes;
  ASSERT_EQ(of_file.size(), baseline.notes.size() + 1);
  EXPECT_EQ(of_file.front().kind, Note::Kind::earlier_version);
  const Ended ended = desk->run("diagnose s.csv --rig rig.toml --params tuned.csv --baseline old.json");
  EXPECT_NE((ended.out + ended.err).find("bound to the bytes of the table's file"), std::string::npos) << ended.out;

  Tuned other = read_tuned("tuned.csv");
  width_of(other.table).nominal *= 1.001;
  EXPECT_EQ(other.table.sha256, baseline.tuned_sha256);
  EXPECT_THROW(require_same_table(baseline, other), InputError) << "changed in memory: the hash of bytes stays";
  desk->write("commented.csv", "# looked over\n" + bytes_of("tuned.csv"));
  EXPECT_THROW(require_same_table(baseline, read_tuned("commented.csv")), InputError);
}

TEST_F(Door, RefusesWhatIsNotTunedAndWhatIsEmpty) {
  EXPECT_THROW(read_tuned("table.csv"), InputError);
  const Tuned tuned = read_tuned("tuned.csv");
  EXPECT_THROW(diagnose(read_log("s.csv", rig()), tuned, rig(), Baseline{}), InputError);
  EXPECT_THROW(write_baseline("empty.json", {}), InputError);
  EXPECT_THROW(History::open_or_make("empty.db").record("V", {}, {}, tuned), InputError);
}

TEST_F(Door, ARigInMemoryIsTheOneInItsFile) {
  const Rig made = make_rig("rig.toml", bytes_of("rig.toml"));
  EXPECT_EQ(made.sha256, rig().sha256);
  EXPECT_EQ(made.facts, rig().facts);
  try {
    make_rig("in memory", "name = \"bench\"\nno_key = 1\n");
    ADD_FAILURE() << "an unknown key";
  } catch (const InputError& error) {
    EXPECT_EQ(error.where.file, "in memory");
    EXPECT_EQ(error.where.line, 2);
  }
}

// A wish to end that is there from the beginning: what comes back has cost next to nothing and says so.
TEST_F(Door, EndsWhereItIsAskedTo) {
  const Watch ended{.progress = {}, .stop = [] { return true; }};
  const Tuned tuned = read_tuned("tuned.csv");
  const Log log = read_log("s.csv", rig());
  const Baseline baseline = read_baseline("base.json");

  const Tuned part = quickly_tuned(ended), whole = quickly_tuned();
  EXPECT_TRUE(part.interrupted);
  EXPECT_FALSE(whole.interrupted);
  EXPECT_LT(part.simulations, whole.simulations);
  EXPECT_EQ(part.table.rows.size(), whole.table.rows.size());

  const Verdict verdict = diagnose(log, tuned, rig(), baseline, {.watch = ended});
  EXPECT_TRUE(verdict.interrupted);
  EXPECT_TRUE(verdict.probabilities.empty());

  const Baseline none = make_baseline(logs({"b1.csv", "b2.csv", "b3.csv"}), tuned, rig(), {.watch = ended});
  EXPECT_TRUE(none.interrupted);
  EXPECT_TRUE(none.scores.empty());

  const Explanation explanation = explain({log}, tuned, rig(), {.watch = ended});
  EXPECT_TRUE(explanation.interrupted);
  EXPECT_TRUE(explanation.causes.empty());
}

}  // namespace
}  // namespace servodx
