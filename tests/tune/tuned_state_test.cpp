// What a tuned table carries beside its rows is typed, replaced by a new tune, and bound to the content of its logs.
#include "fit/tuned_state.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "fit/error_model.h"
#include "fit/recorder.h"
#include "recovery/twins.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "temporary_folder.h"
#include "tune/tune.h"

namespace servodx {
namespace {

const ErrorModel error{{{Signal::spool_position, 1.0 / 3e6, 0.7123456789012345, 0.0123456789},
                        {Signal::pressure_a, 2e5 / 3, 0.0, 1.0},
                        {Signal::piston_position, 0.0, 1e-300, 5e-5}}};

const Recorder recorder{5, CommandSlope{1.0 / 3, 0.0712345678901234}};

TEST(TunedState, ReadsBackFromAFileToTheSameBits) {
  const TemporaryFolder folder;
  Table table = shipped_table();
  table.has_std_error = true;
  table.comments = {"written by something else"};
  set_tuned_state(table, {error, recorder, {{"a \"log\".csv", "ab12", "cd34"}}, {{Signal::pressure_b, 11.25}}});
  write_table(folder / "tuned.csv", table);
  const Table again = read_table(folder / "tuned.csv");
  EXPECT_EQ(again.comments, table.comments);
  EXPECT_EQ(content_hash(again), content_hash(table));
  const TunedState state = tuned_state(again);
  EXPECT_EQ(state.recorder.moving_average, 5);
  ASSERT_TRUE(state.recorder.command_slope);
  EXPECT_EQ(state.recorder.command_slope->usual, recorder.command_slope->usual);
  EXPECT_EQ(state.recorder.command_slope->spread, recorder.command_slope->spread);
  ASSERT_EQ(state.by.size(), 1u);
  EXPECT_EQ(state.by[0].log, "a \"log\".csv");
  EXPECT_EQ(state.by[0].sha256, "ab12");
  EXPECT_EQ(state.by[0].content, "cd34");
  ASSERT_EQ(state.error.channels.size(), error.channels.size());
  for (std::size_t i = 0; i < error.channels.size(); ++i) {
    EXPECT_EQ(state.error.channels[i].signal, error.channels[i].signal);
    EXPECT_EQ(state.error.channels[i].floor, error.channels[i].floor);
    EXPECT_EQ(state.error.channels[i].per_activity, error.channels[i].per_activity);
    EXPECT_EQ(state.error.channels[i].independent, error.channels[i].independent);
  }
  ASSERT_EQ(state.unfollowed.size(), 1u);
  EXPECT_EQ(state.unfollowed[0].signal, Signal::pressure_b);
  EXPECT_EQ(state.unfollowed[0].over_noise, 11.25);
  EXPECT_TRUE(tuned_state(shipped_table()).error.channels.empty());
}

TEST(TunedState, TheHashOfATableIsOfWhatItSays) {
  Table table = shipped_table();
  table.has_std_error = true;
  set_tuned_state(table, {error, recorder, {{"a.csv", "ab12", "cd34"}}, {{Signal::pressure_b, 11.25}}});
  const std::string hash = content_hash(table);
  const auto of = [&](auto&& change) {
    Table other = table;
    change(other);
    return content_hash(other);
  };
  EXPECT_EQ(of([](Table& t) { t.comments.push_back("looked over"); }), hash);
  EXPECT_EQ(of([](Table& t) { t.state += "# a remark\n"; }), hash);
  EXPECT_EQ(of([](Table& t) { t.rows[3].source = "elsewhere", t.path = "other.csv"; }), hash);
  EXPECT_NE(of([](Table& t) { t.rows[3].nominal *= 1 + 1e-15; }), hash);
  EXPECT_NE(of([](Table& t) { t.rows[3].std_error = 1; }), hash);
  const auto by = [](const Recorder& r) {
    return [r](Table& t) {
      set_tuned_state(t, {error, r, {{"a.csv", "ab12", "cd34"}}, {{Signal::pressure_b, 11.25}}});
    };
  };
  EXPECT_EQ(of(by(recorder)), hash);
  EXPECT_NE(of(by({3, recorder.command_slope})), hash);
  EXPECT_NE(of(by({5, {}})), hash);
  Table old = shipped_table();
  old.comments = {"model error spool_position: floor 1e-06 m, per activity 0.1, independent 9.9 1/s"};
  Table moved_on = old;
  set_tuned_state(moved_on, tuned_state(old));
  EXPECT_EQ(content_hash(moved_on), content_hash(old)) << "the same, of an earlier version's comments";
}

TEST(TunedState, TakesInWhatAnOlderVersionKeptInComments) {
  Table table = shipped_table();
  table.comments = {"model errors are not this line",
                    "model error spool_position: floor 1e-06 m, per activity 0.1, independent 9.9 1/s",
                    "tuned by " + std::string(64, 'a') + " h01.csv"};
  EXPECT_TRUE(has_old_state(table));
  set_tuned_state(table, tuned_state(table));
  EXPECT_FALSE(has_old_state(table));
  EXPECT_EQ(table.comments.size(), 1u);
  const TunedState state = tuned_state(table);
  EXPECT_EQ(state.error.channels.at(0).independent, 9.9);
  EXPECT_EQ(state.by.at(0).log, "h01.csv");
}

TEST(TunedState, OfManyLevelsIsRefusedByItsLineAndDoesNotOverflowTheStack) {
  Table table = shipped_table();
  table.state = "[tuned]\na";
  for (int i = 0; i < 50000; ++i) table.state += ".a";
  table.state += " = 1\n";
  try {
    tuned_state(table);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& refusal) {
    EXPECT_EQ(refusal.where.file, table.path);
    EXPECT_EQ(refusal.rule,
              "its lines '#%' cannot be read, the 2. of them nests deeper than 100 levels, at character 198");
  }
}

TEST(TunedState, OfANewerSchemaOrDamagedIsRefused) {
  Table table = shipped_table();
  for (const char* text :
       {"[tuned]\nschema = 99\n", "[tuned\n", "[tuned]\nschema = 1\n[[tuned.error]]\nsignal = \"x\"\n",
        "[tuned]\nschema = 1\n[[tuned.error]]\nsignal = \"pressure_a\"\nfloor = 1\n",
        "[tuned]\nschema = 1\n[tuned.command_slope]\nusual = 2\nspread = 1\n",
        "[tuned]\nschema = 1\n[tuned.command_slope]\nusual = 1\n"}) {
    table.state = text;
    EXPECT_THROW(tuned_state(table), InputError) << text;
  }
}

TuneOptions quick() {
  TuneOptions o;
  o.generations = 0;
  o.rounds = 1;
  o.effects.emplace();
  return o;
}

Table with_few_rows() {
  Table table = shipped_table();
  for (Row& row : table.rows)
    row.estimate = std::find(twins::rows().begin(), twins::rows().begin() + 4, row.name) != twins::rows().begin() + 4;
  return table;
}

TEST(TunedState, ATuneOfThreeLogsSaysHowTheyWereRecordedAndOneOfTwoDoesNot) {
  std::vector<Log> logs;
  for (const char* name : {"healthy/h08_preflight_cold", "healthy/h09_preflight_hot", "healthy/h12_mixed"})
    logs.push_back(twins::cut(shipped_log(name), 300));
  const Recorder three = recorder_of(tune_table(logs, with_few_rows(), shipped_rig(), quick()).table);
  ASSERT_TRUE(three.command_slope);
  EXPECT_GT(three.command_slope->spread, 0);
  logs.pop_back();
  EXPECT_FALSE(recorder_of(tune_table(logs, with_few_rows(), shipped_rig(), quick()).table).command_slope);
}

TEST(TunedState, ATuneOfATunedTableReplacesIt) {
  const Log first = twins::cut(shipped_log("healthy/h08_preflight_cold"), 300);
  const Log second = twins::cut(shipped_log("healthy/h09_preflight_hot"), 300);
  TuneOptions smoothed = quick();
  smoothed.moving_average = 3;
  const TuneResult once = tune_table({first}, with_few_rows(), shipped_rig(), smoothed);
  const TuneResult twice = tune_table({second}, once.table, shipped_rig(), quick());
  const TunedState state = tuned_state(twice.table);
  EXPECT_EQ(state.recorder.moving_average, 1);
  ASSERT_EQ(state.by.size(), 1u);
  EXPECT_TRUE(state.is_by(second));
  EXPECT_FALSE(state.is_by(first));
  ASSERT_EQ(state.error.channels.size(), twice.error.channels.size());
  for (std::size_t i = 0; i < state.error.channels.size(); ++i)
    EXPECT_EQ(state.error.channels[i].independent, twice.error.channels[i].independent);
  EXPECT_NE(tuned_state(once.table).error.channels[0].independent, state.error.channels[0].independent);
}

TEST(TunedState, KnowsALogByItsContent) {
  Log log = twins::cut(shipped_log("healthy/h08_preflight_cold"), 300);
  TunedState state;
  state.by = {{"h08.csv", "", content_hash(log)}};
  log.path = "another name", log.sha256 = "other bytes", log.notes = {{Note::Kind::gaps, "a notice"}};
  EXPECT_TRUE(state.is_by(log));
  log.channels[index(Signal::pressure_a)].value[7] += 1;
  EXPECT_FALSE(state.is_by(log));
}

}  // namespace
}  // namespace servodx
