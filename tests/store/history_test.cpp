// The store: nothing acknowledged is lost, nothing foreign is touched.
#include "store/history.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <utility>

#include "base/error.h"
#include "base/random.h"
#include "base/reading_limits.h"
#include "prognose/check.h"
#include "prognose/valve_history.h"
#include "servodx/history.h"
#include "servodx/maintenance.h"
#include "store/history_csv.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

class Histories : public testing::Test {
 protected:
  std::string file(const std::string& name = "h.db") const { return folder / name; }
  TemporaryFolder folder;
};

Recording a_check(double at, double value = 1.25) {
  Recording r;
  r.at = at;
  r.log = "log.csv";
  r.log_sha256 = "sha" + std::to_string(at);
  r.table_sha256 = "table";
  r.version = "1";
  r.recorded_at = "2026-01-01T00:00:00Z";
  r.temperature = 313.15;
  r.temperature_source = "given";
  r.checks = {{"fidelity", value, 0.01, "1", value, 1.0, ""},
              {"parameter:9", 2e-6, std::nan(""), "m", 2e-6, 1.0, "feedback_wire_backlash"}};
  return r;
}

TEST_F(Histories, WhatIsRecordedIsReadBackInOrderOfHours) {
  {
    HistoryFile h(file(), true);
    h.record("v1", "SN 7", a_check(20, 0.1 + 0.2), "text");
    h.record("v1", "", a_check(10), "text");
    h.add_event("v1", {15, EventKind::filter_changed, "new screen", ""});
  }
  const HistoryFile h(file(), false);
  const ValveHistory v = h.of("v1");
  EXPECT_EQ(v.serial, "SN 7");
  ASSERT_EQ(v.recordings.size(), 2u);
  EXPECT_EQ(v.recordings[0].at, 10);
  EXPECT_EQ(v.recordings[1].checks[0].value, 0.1 + 0.2);
  EXPECT_TRUE(std::isnan(v.recordings[1].checks[1].std_error));
  ASSERT_EQ(v.events.size(), 1u);
  EXPECT_EQ(v.events[0].kind, EventKind::filter_changed);
  EXPECT_EQ(h.verify(), "ok");
  EXPECT_THROW(h.of("v2"), InputError);
}

TEST(Events, AreFoundByTheNameThatTheyHave) {
  const std::pair<EventKind, std::string> names[] = {{EventKind::filter_changed, "filter_changed"},
                                                     {EventKind::valve_swapped, "valve_swapped"},
                                                     {EventKind::overhauled, "overhauled"},
                                                     {EventKind::retuned, "retuned"},
                                                     {EventKind::note, "note"}};
  std::string all;
  for (const auto& [kind, name] : names) {
    EXPECT_EQ(name_of(kind), name);
    EXPECT_EQ(find_event(name), kind);
    all += (all.empty() ? "" : ", ") + name;
  }
  EXPECT_EQ(event_names(), all);
  EXPECT_FALSE(find_event("no_such_event").has_value());
}

TEST_F(Histories, TheSameLogAtTheSameHoursIsRefused) {
  HistoryFile h(file(), true);
  h.record("v1", "", a_check(10), "");
  EXPECT_THROW(h.record("v1", "", a_check(10), ""), InputError);
  EXPECT_EQ(h.of("v1").recordings.size(), 1u);
}

TEST_F(Histories, HoldsWhatItWouldRefuseAndNothingElse) {
  HistoryFile h(file(), true);
  const Recording recorded = a_check(10);
  EXPECT_FALSE(h.holds("v1", recorded));
  h.record("v1", "", recorded, "");
  EXPECT_TRUE(h.holds("v1", recorded));
  EXPECT_FALSE(h.holds("v2", recorded));
  for (const auto change : {+[](Recording& r) { r.at = 11; }, +[](Recording& r) { r.log_sha256 = "other"; },
                            +[](Recording& r) { r.table_sha256 = "other"; }}) {
    Recording other = recorded;
    change(other);
    EXPECT_FALSE(h.holds("v1", other));
    h.record("v1", "", other, "");
  }
  EXPECT_EQ(h.of("v1").recordings.size(), 4u);
}

TEST_F(Histories, CsvThereAndBackGivesTheSameBits) {
  HistoryFile h(file(), true);
  for (int k = 0; k < 5; ++k) h.record("valve, \"left\"", "SN", a_check(k / 3.0, k / 7.0), "id,name\n1,\"x\"\n");
  h.add_event("valve, \"left\"", {1.5, EventKind::note, "two\nlines; ü", ""});
  const std::string text = history_csv(h.content());
  std::ofstream(file("h.csv"), std::ios::binary) << text;
  HistoryFile other(file("other.db"), true);
  const Restored first = other.restore(read_history_csv(file("h.csv")));
  EXPECT_EQ(first.recordings, 5);
  EXPECT_EQ(first.events, 1);
  EXPECT_EQ(history_csv(other.content()), text);
  const Restored second = other.restore(read_history_csv(file("h.csv")));
  EXPECT_EQ(second.recordings + second.events, 0);
  EXPECT_EQ(second.present, 6);
}

TEST_F(Histories, ABrokenCsvIsRefusedAtItsLineAndAddsNothing) {
  HistoryFile h(file(), true);
  h.record("v1", "", a_check(10), "");
  std::string text = history_csv(h.content());
  text.replace(text.rfind("10,"), 2, "ten");
  std::ofstream(file("bad.csv")) << text;
  try {
    read_history_csv(file("bad.csv"));
    FAIL();
  } catch (const InputError& e) {
    EXPECT_EQ(e.where.line, 4);
    EXPECT_EQ(e.where.column, "at [h]");
  }
}

TEST_F(Histories, ACsvOfAnotherOriginNeedsValveHoursNameAndValue) {
  std::ofstream(file("other.csv")) << "at [h],valve,name,value,oil_temperature [degC]\n"
                                      "1,v1,fidelity,1.2,\n1,v1,parameter:9,3e-6,40\n5,v1,fidelity,1.3,-10\n";
  const HistoryContent content = read_history_csv(file("other.csv"));
  HistoryFile h(file(), true);
  EXPECT_EQ(h.restore(content).recordings, 2);
  const ValveHistory v = h.of("v1");
  ASSERT_EQ(v.recordings.size(), 2u);
  EXPECT_EQ(v.recordings[0].checks.size(), 2u);
  EXPECT_EQ(v.recordings[1].checks[0].measured, 1.3);
  EXPECT_EQ(v.recordings[1].checks[0].expected, 1.0);
  EXPECT_NEAR(v.recordings[1].temperature, 263.15, 1e-9);
  std::ofstream(file("typo.csv")) << "at [h],valve,name,valeu\n1,v1,fidelity,1.2\n";
  EXPECT_THROW(read_history_csv(file("typo.csv")), InputError);
}

TEST_F(Histories, NamesAndFilesBeyondTheStatedLimitsAreRefused) {
  const std::string name(longest_name + 1, 'v');
  HistoryFile h(file(), true);
  EXPECT_THROW(h.record(name, "SN", a_check(1, 1), "id,name\n"), InputError);
  EXPECT_THROW(h.record("v1", name, a_check(1, 1), "id,name\n"), InputError);
  EXPECT_TRUE(h.valves().empty());
  std::ofstream(file("long.csv")) << "at [h],valve,name,value\n1," << name << ",fidelity,1.2\n";
  EXPECT_THROW(read_history_csv(file("long.csv")), InputError);
  std::ofstream(file("large.csv")) << "at [h],valve,name,value\n1,v1,fidelity,1.2\n";
  std::filesystem::resize_file(file("large.csv"), largest_history + 1);
  try {
    read_history_csv(file("large.csv"));
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.rule, "has more than 1024 MB, the most that such a file may");
  }
}

TEST_F(Histories, RowsOfOneCheckNeedNotStandTogether) {
  std::ofstream(file("by_name.csv")) << "valve,at [h],name,value\nv1,1,fidelity,1.2\nv1,2,fidelity,1.3\n"
                                        "v1,1,parameter:9,3e-6\nv1,2,parameter:9,4e-6\n";
  HistoryFile h(file(), true);
  EXPECT_EQ(h.restore(read_history_csv(file("by_name.csv"))).recordings, 2);
  for (const Recording& r : h.of("v1").recordings) EXPECT_EQ(r.checks.size(), 2u);
  std::ofstream(file("twice.csv"))
      << "valve,at [h],name,value\nv1,1,fidelity,1.2\nv1,2,fidelity,1.3\nv1,1,fidelity,1.4\n";
  EXPECT_THROW(read_history_csv(file("twice.csv")), InputError);
}

TEST_F(Histories, AnImportThatContradictsTheHistoryIsRefusedWhole) {
  const auto csv = [&](const char* rows) {
    std::ofstream(file("rows.csv")) << "valve,at [h],name,value\n" << rows;
    return read_history_csv(file("rows.csv"));
  };
  HistoryFile h(file(), true);
  h.restore(csv("v1,1,fidelity,1.2\n"));
  EXPECT_EQ(h.restore(csv("v1,1,fidelity,1.2\n")).present, 1);
  EXPECT_THROW(h.restore(csv("v1,2,fidelity,1.2\nv1,1,fidelity,1.3\n")), InputError) << "another value";
  EXPECT_THROW(h.restore(csv("v1,2,fidelity,1.2\nv1,1,parameter:9,1e-6\n")), InputError) << "another figure";
  EXPECT_EQ(h.of("v1").recordings.size(), 1u);
}

TEST_F(Histories, AnImportTakesUnitsAtTheirWord) {
  const auto read = [&](const char* row) {
    std::ofstream(file("row.csv")) << "valve,at [h],name,value,std_error,unit\n" << row;
    return read_history_csv(file("row.csv")).valves.front().recordings.front().checks.front();
  };
  const Check c = read("v1,1,parameter:9,15,0.5,um\n");
  EXPECT_NEAR(c.value, 15e-6, 1e-18);
  EXPECT_NEAR(c.std_error, 0.5e-6, 1e-18);
  EXPECT_EQ(c.unit, "m");
  EXPECT_EQ(read("v1,1,fidelity,1.2,0.1,-\n").value, 1.2);
  EXPECT_THROW(read("v1,1,parameter:9,15,0.5,bar\n"), InputError);
  EXPECT_THROW(read("v1,1,parameter:9,15,0.5,bananas\n"), InputError);
}

TEST_F(Histories, AnImportRefusesWhatNoValveCanRead) {
  for (const char* row : {"v1,-5,1,fidelity,1.2,0.1,313", "v1,5,-7,fidelity,1.2,0.1,313",
                          "v1,5,1,fidelity,1.2,-0.1,313", "v1,5,1,fidelity,1.2,0.1,40",
                          "v1,5,1,parameter:99,1.2,0.1,313", "v1,5,1,parameter:x,1.2,0.1,313", "v1,5,1,,1.2,0.1,313"}) {
    std::ofstream(file("row.csv")) << "valve,at [h],cycles,name,value,std_error,oil_temperature [K]\n"
                                      "v1,4,0,fidelity,1.2,0.1,313\n"
                                   << row << "\n";
    try {
      read_history_csv(file("row.csv"));
      ADD_FAILURE() << row;
    } catch (const InputError& e) {
      EXPECT_EQ(e.where.line, 3) << row;
    }
  }
}

TEST_F(Histories, AnEmptyFileIsNoHistory) {
  std::ofstream(file("empty.db")).flush();
  EXPECT_THROW(HistoryFile(file("empty.db"), false), InputError);
  EXPECT_EQ(std::filesystem::file_size(file("empty.db")), 0u);
}

TEST_F(Histories, AnEmptyFileIsFilledAsIfItWereNotThere) {
  std::ofstream(file()).flush();
  EXPECT_FALSE(HistoryFile::there(file()));
  HistoryFile(file(), true).record("v1", "", a_check(1), "");
  EXPECT_TRUE(HistoryFile::there(file()));
  EXPECT_EQ(HistoryFile(file(), false).of("v1").recordings.size(), 1u);
}

// A child that ends with 0 where `work` throws nothing.
template <class Work>
pid_t in_child(const Work& work) {
  const pid_t child = fork();
  if (child != 0) return child;
  try {
    work();
  } catch (...) {
    _exit(1);
  }
  _exit(0);
}

TEST_F(Histories, OneWhoseMakerIsKilledIsWholeOrNotThere) {
  Random random(12);
  constexpr int kills = 20;
  for (int k = 0; k < kills; ++k) {
    const std::string path = file(std::string(1, static_cast<char>('a' + k)));
    const pid_t child = in_child([&] { HistoryFile(path, true); });
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(6000)));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(fs::exists(path), HistoryFile::there(path)) << "an empty file after kill " << k;
    if (fs::exists(path)) {
      EXPECT_EQ(HistoryFile(path, false).verify(), "ok");
    }
    HistoryFile(path, true).record("v1", "", a_check(1), "");  // what is left of the first hinders nobody
    EXPECT_EQ(HistoryFile(path, false).of("v1").recordings.size(), 1u);
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()), kills);
}

TEST_F(Histories, OneThatHasNoRoomIsNotThere) {
  const pid_t child = in_child([&] {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{2000, 2000};
    setrlimit(RLIMIT_FSIZE, &limit);
    HistoryFile(file(), true);
  });
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 1) << "the failure was not reported";
  EXPECT_TRUE(fs::is_empty(folder.path));
}

TEST_F(Histories, FirstWritersAtOnceLoseNothing) {
  constexpr int writers = 6;
  for (const bool empty : {false, true}) {
    const std::string path = file(empty ? "empty.db" : "new.db");
    if (empty) std::ofstream(path).flush();
    std::vector<pid_t> children;
    for (int w = 0; w < writers; ++w)
      children.push_back(in_child(
          [&] { HistoryFile(path, true).record(std::string(1, static_cast<char>('a' + w)), "", a_check(w), ""); }));
    for (const pid_t child : children) {
      int status = 0;
      waitpid(child, &status, 0);
      EXPECT_EQ(WEXITSTATUS(status), 0);
    }
    EXPECT_EQ(HistoryFile(path, false).valves().size(), static_cast<std::size_t>(writers));
  }
}

TEST_F(Histories, AnOlderSchemaIsBroughtUpAndKeepsItsRows) {
  {
    HistoryFile h(file(), true);
    h.record("v1", "", a_check(10), "");
  }
  {
    SQLite::Database raw(file(), SQLite::OPEN_READWRITE);
    raw.exec("DROP INDEX recording_of_valve; DROP INDEX event_of_valve; PRAGMA user_version = 1");
  }
  const HistoryFile h(file(), false);
  EXPECT_EQ(h.of("v1").recordings.size(), 1u);
  SQLite::Database raw(file());
  EXPECT_EQ(raw.execAndGet("PRAGMA user_version").getInt(), HistoryFile::schema_version());
  EXPECT_EQ(raw.execAndGet("SELECT count(*) FROM sqlite_master WHERE name = 'recording_of_valve'").getInt(), 1);
}

TEST_F(Histories, ANewerSchemaAnotherProgramsFileAndADamagedFileAreRefusedUntouched) {
  { HistoryFile h(file(), true); }
  { SQLite::Database(file(), SQLite::OPEN_READWRITE).exec("PRAGMA user_version = 99"); }
  EXPECT_THROW(HistoryFile(file(), true), InputError);
  { SQLite::Database(file("other.db"), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE).exec("CREATE TABLE mine(x)"); }
  EXPECT_THROW(HistoryFile(file("other.db"), true), InputError);
  const std::string noise(4096, 'x');
  std::ofstream(file("noise.db")) << noise;
  EXPECT_THROW(HistoryFile(file("noise.db"), true), InputError);
  std::ifstream in(file("noise.db"));
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), noise);
  EXPECT_THROW(HistoryFile(file("missing.db"), false), InputError);
}

TEST_F(Histories, ADamagedPageIsReportedNotReadOver) {
  {
    HistoryFile h(file(), true);
    for (int k = 0; k < 200; ++k) h.record("v1", "", a_check(k), "");
  }
  {
    std::fstream f(file(), std::ios::in | std::ios::out | std::ios::binary);
    f.seekp(4096 * 3);
    const std::string noise(4096 * 4, '\xa5');
    f.write(noise.data(), static_cast<long>(noise.size()));
  }
  const auto read_all = [&] {
    const HistoryFile h(file(), false);
    if (h.verify() != "ok") throw InputError({}, "damaged", "");
    h.of("v1");
  };
  EXPECT_THROW(read_all(), InputError);
}

// A limit on the size of files stands for a full disk: the write fails in mid-transaction.
TEST_F(Histories, AWriteThatFailsLosesItsCheckSaysSoAndKeepsTheRest) {
  { HistoryFile h(file(), true); }
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{200000, 200000};
    setrlimit(RLIMIT_FSIZE, &limit);
    int code = 1;
    try {
      HistoryFile h(file(), true);
      for (int k = 0; k < 2000; ++k) {
        h.record("v1", "", a_check(k), std::string(500, 'x'));
        if (write(ends[1], "+", 1) != 1) _exit(2);
      }
    } catch (const InputError&) {
    } catch (const std::runtime_error&) {
      code = 0;
    }
    _exit(code);
  }
  close(ends[1]);
  std::size_t acknowledged = 0;
  char byte;
  while (read(ends[0], &byte, 1) == 1) ++acknowledged;
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "the failure was not reported";
  const HistoryFile h(file(), false);
  EXPECT_EQ(h.verify(), "ok");
  EXPECT_GT(acknowledged, 3u);
  EXPECT_EQ(h.of("v1").recordings.size(), acknowledged);
}

TEST_F(Histories, WritersOfSeveralProcessesLoseNothing) {
  { HistoryFile h(file(), true); }
  constexpr int writers = 4, each = 25;
  std::vector<pid_t> children;
  for (int w = 0; w < writers; ++w) {
    const pid_t child = fork();
    if (child == 0) {
      int code = 0;
      try {
        HistoryFile h(file(), true);
        for (int k = 0; k < each; ++k) h.record("v" + std::to_string(w), "", a_check(k), "");
      } catch (...) {
        code = 1;
      }
      _exit(code);
    }
    children.push_back(child);
  }
  for (pid_t child : children) {
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }
  const HistoryFile h(file(), false);
  for (int w = 0; w < writers; ++w) EXPECT_EQ(h.of("v" + std::to_string(w)).recordings.size(), 25u);
}

// A child records and acknowledges each check through a pipe; it is killed at a random moment. SERVODX_KILLS=200 for
// the full count.
TEST_F(Histories, AKilledWriterLosesNoAcknowledgedCheck) {
  const char* asked = std::getenv("SERVODX_KILLS");
  const int kills = asked ? std::atoi(asked) : 25;
  Random random(11);
  int acknowledged = 0;
  for (int k = 0; k < kills; ++k) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      close(ends[0]);
      try {
        HistoryFile h(file(), true);
        for (int i = acknowledged;; ++i) {
          h.record("v1", "", a_check(i), "table text");
          if (write(ends[1], "+", 1) != 1) _exit(2);
        }
      } catch (...) {
      }
      _exit(1);
    }
    close(ends[1]);
    std::this_thread::sleep_for(std::chrono::microseconds(random.below(40000)));
    char byte;
    if (k + 1 == kills && read(ends[0], &byte, 1) == 1) ++acknowledged;  // on a busy disk none may have come so far
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status)) << "the writer ended by itself";
    while (read(ends[0], &byte, 1) == 1) ++acknowledged;
    close(ends[0]);
    if (!fs::exists(file())) continue;
    const HistoryFile h(file(), false);
    ASSERT_EQ(h.verify(), "ok") << "after kill " << k;
    const std::vector<std::string> valves = h.valves();
    const auto stored = valves.empty() ? 0 : static_cast<int>(h.of("v1").recordings.size());
    ASSERT_GE(stored, acknowledged) << "after kill " << k;
    ASSERT_LE(stored, acknowledged + 1) << "one check may be stored and not yet acknowledged";
    acknowledged = stored;
  }
  EXPECT_GT(acknowledged, 0);
}

TEST_F(Histories, TheTrendOfOneValveIsReadThroughAnIndex) {
  { HistoryFile h(file(), true); }
  SQLite::Database raw(file());
  SQLite::Statement plan(raw,
                         "EXPLAIN QUERY PLAN SELECT r.id FROM recording r LEFT JOIN figure f ON f.recording = r.id "
                         "WHERE valve = 1 ORDER BY at");
  while (plan.executeStep())
    EXPECT_EQ(plan.getColumn(3).getString().find("SCAN"), std::string::npos) << plan.getColumn(3).getString();
}

TEST(HistoryEvents, AFilterChangeRenewsWhatSeesTheFilterAndASwapRenewsAll) {
  const Check fidelity{"fidelity", 0, 0, "1", 0, 1, ""},
      backlash{"parameter:9", 0, 0, "m", 0, 1, "feedback_wire_backlash"},
      filter{"parameter:1", 0, 0, "-", 0, 1, "clogged_filter"};
  EXPECT_TRUE(resets(EventKind::filter_changed, filter));
  EXPECT_TRUE(resets(EventKind::filter_changed, fidelity));
  EXPECT_FALSE(resets(EventKind::filter_changed, backlash));
  EXPECT_TRUE(resets(EventKind::valve_swapped, backlash));
  EXPECT_FALSE(resets(EventKind::note, filter));
}

}  // namespace
}  // namespace servodx
