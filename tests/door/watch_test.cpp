// Progress of the front door, and logs that never were in a file.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "servodx/servodx.h"
#include "shipped_data.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

// What is told of each work: its parts, in the order in which they were told.
struct Told {
  std::mutex mutex;
  std::map<std::string, std::vector<double>> parts;
  Watch watch() {
    return {.progress =
                [this](const WorkDone& done) {
                  const std::scoped_lock lock(mutex);
                  parts[std::string(done.work)].push_back(done.part);
                },
            .stop = {}};
  }
};

// The first samples of a shipped log, by way of columns in memory.
Log in_memory(const std::string& name, std::size_t samples) {
  const Log log = shipped_log(name);
  const auto column = [&](const std::string& head, const std::vector<double>& values) {
    return LogColumn{head, {values.begin(), values.begin() + static_cast<long>(samples)}};
  };
  std::vector<LogColumn> columns = {column("time [s]", log.time)};
  for (const auto& [signal, unit] : {std::pair{Signal::command, "A"}, std::pair{Signal::spool_position, "m"},
                                     std::pair{Signal::piston_position, "m"}, std::pair{Signal::pressure_a, "Pa"},
                                     std::pair{Signal::pressure_b, "Pa"}})
    columns.push_back(column(std::string(name_of(signal)) + " [" + unit + "]", log[signal]));
  return make_log(name, columns, shipped_rig());
}

// A fit takes a turned column for a valve's: its tune says which one it is.
TEST(Watch, ATuneNotesAColumnWhoseSignIsTurned) {
  TuneOptions quick;
  quick.generations = 0, quick.rounds = 1, quick.effects.emplace();
  const auto notes_of = [&](double sign) {
    Log log = in_memory("healthy/h12_mixed", 1500);
    for (double& x : log.channels[index(Signal::piston_position)].value) x *= sign;
    const Tuned tuned = tune({log}, read_table(shipped("params/borello2009.csv")), shipped_rig(), quick);
    return std::count_if(tuned.notes.begin(), tuned.notes.end(), [](const Note& n) {
      return n.kind == Note::Kind::implausible && n.text.find("'piston_position' runs against") != std::string::npos;
    });
  };
  EXPECT_EQ(notes_of(1), 0);
  EXPECT_EQ(notes_of(-1), 1);
}

TEST(Watch, IsToldOfEveryWorkAndABaselineInMemoryBindsToItsTable) {
  const Rig rig = shipped_rig();
  Told told;
  TuneOptions quick;
  quick.generations = 0, quick.rounds = 1, quick.effects.emplace();
  quick.watch = told.watch();
  const Tuned tuned =
      tune({in_memory("healthy/h12_mixed", 700)}, read_table(shipped("params/borello2009.csv")), rig, quick);
  const auto noted = [&](Note::Kind kind) { return std::ranges::find(tuned.notes, kind, &Note::kind); };
  ASSERT_LT(noted(Note::Kind::search_end), noted(Note::Kind::command_slope)) << "ahead of what logs say";
  EXPECT_TRUE(noted(Note::Kind::search_end)->text.starts_with("local stage: "));
  const Log own = in_memory("healthy/h04_multisine", 300);
  const Baseline baseline =
      make_baseline({in_memory("healthy/h15_no_supply_signals", 300), own, in_memory("healthy/h03_sine_2hz", 300)},
                    tuned, rig, {.false_alarm = 0.3, .watch = told.watch()});
  const Log suspect = in_memory("fault/f02_clogged_filter_severe", 300);
  const Verdict verdict = diagnose(suspect, tuned, rig, baseline, {.watch = told.watch()});
  EXPECT_FALSE(verdict.interrupted);
  EXPECT_FALSE(verdict.probabilities.empty());
  const Explanation explanation = explain({suspect}, tuned, rig, baseline, {.watch = told.watch()});
  EXPECT_FALSE(explanation.interrupted);

  for (const char* work : {"tune", "baseline", "diagnose", "explain", "explain, missing input"}) {
    const std::vector<double>& parts = told.parts[work];
    ASSERT_FALSE(parts.empty()) << work;
    EXPECT_GE(*std::min_element(parts.begin(), parts.end()), 0) << work;
    EXPECT_LE(*std::max_element(parts.begin(), parts.end()), 1) << work;
  }
  EXPECT_EQ(told.parts.size(), 5u);
  const std::vector<double>& both = told.parts["baseline"];
  EXPECT_TRUE(std::is_sorted(both.begin(), both.end())) << "two halves, one bar";

  EXPECT_FALSE(require_same_table(baseline, tuned)) << "nothing to note";
  EXPECT_TRUE(notes_beside(baseline, rig, {suspect}).empty());
  Rig thinner = rig;
  thinner.path = "other.toml", thinner.facts["supply.pressure"] = 140e5, thinner.facts.erase("valve.spool_stroke");
  Log fewer = suspect;
  fewer.channels[index(Signal::pressure_b)].value.clear();
  const std::vector<Note> notes = notes_beside(baseline, thinner, {suspect, fewer});
  ASSERT_EQ(notes.size(), 2u);
  ASSERT_EQ(notes_beside(baseline, rig, {own}).size(), 1u) << "it never was in a file, and is known by its samples";
  EXPECT_EQ(notes_beside(baseline, rig, {own}).front().kind, Note::Kind::own_log);
  EXPECT_EQ(notes[0].kind, Note::Kind::other_rig);
  EXPECT_NE(notes[0].text.find("supply.pressure, valve.spool_stroke; what follows"), std::string::npos)
      << notes[0].text;
  EXPECT_EQ(notes[1].kind, Note::Kind::lacking_channels);
  EXPECT_NE(notes[1].text.find("lacks pressure_b,"), std::string::npos) << notes[1].text;
  Tuned other = tuned;
  other.table.rows.front().nominal += 1e-3;  // in memory: its hash of bytes stays
  try {
    diagnose(suspect, other, rig, baseline);
    ADD_FAILURE() << "a verdict by another table's threshold";
  } catch (const InputError& error) {
    EXPECT_NE(error.rule.find("another table than the table in memory"), std::string::npos) << error.what();
  }
  EXPECT_THROW(make_baseline({in_memory("healthy/h12_mixed", 700)}, tuned, rig), InputError) << "it tuned the table";
}

// Stopped where it may be, and gone on with in another call: by `Watch::checkpoint` or by the tune's own options.
TEST(Checkpoints, AStoppedTuneGoesOnToTheSameTable) {
  const Rig rig = shipped_rig();
  const Table table = read_table(shipped("params/borello2009.csv"));
  const std::vector<Log> logs = {in_memory("healthy/h12_mixed", 400)};
  TuneOptions quick;
  quick.generations = 2, quick.rounds = 1, quick.effects.emplace();
  const Tuned whole = tune(logs, table, rig, quick);
  const TemporaryFolder folder;
  for (const int stopped_at : {12, 30}) {
    std::atomic<int> told = 0;
    std::atomic<bool> stop = false;
    TuneOptions broken = quick;
    broken.watch = {.progress = [&](const WorkDone&) { stop = stop || ++told >= stopped_at; },
                    .stop = [&] { return stop.load(); },
                    .checkpoint = open_checkpoint(folder / "tune.ckpt", CheckpointUse::begin)};
    EXPECT_TRUE(tune(logs, table, rig, broken).interrupted) << stopped_at;
    const long kept = report_of(*broken.watch.checkpoint).kept;
    EXPECT_GT(kept, 0) << stopped_at;
    broken.watch = {};
    broken.checkpoint = folder / "tune.ckpt", broken.resume = true;
    const Tuned resumed = tune(logs, table, rig, broken);
    EXPECT_EQ(resumed.table.sha256, whole.table.sha256) << stopped_at;
    EXPECT_EQ(resumed.simulations, whole.simulations) << stopped_at;
    EXPECT_EQ(resumed.failed_simulations, whole.failed_simulations) << stopped_at;
    EXPECT_FALSE(resumed.interrupted);
  }
}

}  // namespace
}  // namespace servodx
