#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/machine_load.h"
#include "base/progress.h"
#include "base/recent_rate.h"
#include "base/sha256.h"
#include "servodx/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

std::size_t entries(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtomicFile, WhatIsWrittenIsWhatIsRead) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  write_file(path, "one");
  EXPECT_EQ(read_file(path), "one");
  write_file(path, "two\n");
  EXPECT_EQ(read_file(path), "two\n");
  EXPECT_EQ(entries(folder.path), 1u);
}

TEST(AtomicFile, WithoutCommitTheTargetIsAsBeforeAndNothingIsLeft) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  write_file(path, "old");
  {
    AtomicFile file(path);
    file.write("new");
    EXPECT_EQ(read_file(path), "old");
  }
  EXPECT_EQ(read_file(path), "old");
  EXPECT_EQ(entries(folder.path), 1u);
}

TEST(AtomicFile, ALinkStaysALinkAndPermissionsStay) {
  const TemporaryFolder folder;
  write_file(folder / "a", "old");
  ASSERT_EQ(::chmod((folder / "a").c_str(), 0640), 0);
  fs::create_symlink("a", folder / "b");
  write_file(folder / "b", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "b"));
  EXPECT_EQ(read_file(folder / "a"), "new");
  struct stat status {};
  ::stat((folder / "a").c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
}

TEST(AtomicFile, ALinkToNothingMakesWhatItPointsTo) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "far");
  fs::create_symlink("far/a", folder / "b");
  fs::create_symlink("b", folder / "c");
  write_file(folder / "c", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "b") && fs::is_symlink(folder / "c"));
  EXPECT_EQ(read_file(folder / "far/a"), "new");
  EXPECT_EQ(entries(folder.path / "far"), 1u);
}

TEST(AtomicFile, WhatAKilledWriterLeftIsTakenAwayByTheNext) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  const pid_t child = ::fork();
  if (child == 0) {
    AtomicFile file(path);
    file.write("half");
    ::_exit(0);  // as a kill: no destructor runs
  }
  ::waitpid(child, nullptr, 0);
  ASSERT_EQ(entries(folder.path), 1u);
  write_file(path, "whole");
  EXPECT_EQ(entries(folder.path), 1u);
  EXPECT_EQ(read_file(path), "whole");
}

TEST(AtomicFile, WritersOfOneTargetDoNotMeet) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.csv";
  std::vector<std::thread> writers;
  for (int w = 0; w < 4; ++w)
    writers.emplace_back([&path, w] {
      for (int k = 0; k < 25; ++k) write_file(path, std::string(1000, static_cast<char>('a' + w)));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string left = read_file(path);
  EXPECT_EQ(left, std::string(1000, left.front()));
  EXPECT_EQ(entries(folder.path), 1u);
}

TEST(AtomicFile, ANewFileTakesNobodysPlace) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.db";
  AtomicFile late(path);
  AtomicFile first(path);
  first.write("first");
  late.write("late");
  EXPECT_TRUE(first.commit_new());
  EXPECT_FALSE(late.commit_new());
  EXPECT_EQ(read_file(path), "first");
}

TEST(AtomicFile, ADeviceIsWrittenInPlace) {
  write_file("/dev/null", "x");
  EXPECT_FALSE(fs::is_regular_file("/dev/null"));
}

TEST(AtomicFile, AMissingFolderIsTheCallersError) {
  const TemporaryFolder folder;
  const std::string path = folder / "no/such.csv";
  try {
    write_file(path, "x");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(),
              path + ": cannot be written: No such file or directory; check that the folder exists and may be written");
  }
  EXPECT_THROW(write_file(folder.path.string(), "x"), InputError);
}

TEST(ReadFile, RefusesWhatCannotBeRead) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_file(folder / "none"), InputError);
  EXPECT_THROW(read_file(folder.path.string()), InputError);
}

TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  const TemporaryFolder folder;
  write_file(folder / "abc", "abc");
  EXPECT_EQ(sha256_of_file(folder / "abc"), sha256("abc"));
}

TEST(Progress, SaysPartRateAndTimeLeft) {
  EXPECT_EQ(progress_line("tune", 0.5, 1000, 10.0, 0.05), "tune: 50 %, 100 evaluations/s, 10 s left");
  EXPECT_EQ(progress_line("tune", 0.25, 30, 20.0, 0.0125), "tune: 25 %, 1.5 evaluations/s, 1 min 0 s left");
  EXPECT_EQ(progress_line("tune", 0.0, 0, 2.0, {}), "tune: 0 %");
  EXPECT_EQ(progress_line("tune", 0.1, 0, 2.0, {}), "tune: 10 %");
  EXPECT_EQ(logs_line("diagnose", 12, 24, 6, 60.0, 0.2), "diagnose: 12 of 24 logs, 6.0 logs/min, 1 min 0 s left");
  EXPECT_EQ(logs_line("diagnose", 12, 24, 0, 60.0, {}), "diagnose: 12 of 24 logs");
}

// [s] left after `until`, where a run has done `part(t)` at t, looked at four times a second.
double left_after(double until, const std::function<double(double)>& part) {
  RecentRate rate;
  for (double t = 0; t <= until; t += 0.25) rate.add(t, part(t));
  const auto now = rate.per_second();
  return now ? (1 - part(until)) / *now : -1;
}

TEST(TimeLeft, OfASteadyRunIsExact) {
  const auto part = [](double t) { return t / 200; };
  EXPECT_NEAR(left_after(50, part), 150, 1);
  EXPECT_NEAR(left_after(190, part), 10, 1);
}

// Half is done in the first 50 s; the other half takes 450 s. The mean of the run would say 90 s, 140 s and 163 s.
TEST(TimeLeft, FollowsARunThatSlowsDown) {
  const auto part = [](double t) { return t < 50 ? t / 100 : 0.5 + (t - 50) / 900; };
  EXPECT_NEAR(left_after(90, part), 410, 15);
  EXPECT_NEAR(left_after(140, part), 360, 15);
}

TEST(TimeLeft, FollowsARunThatSpeedsUp) {
  const auto part = [](double t) { return t < 450 ? t / 900 : 0.5 + (t - 450) / 100; };
  EXPECT_LT(left_after(470, part), 70);  // the mean of the run would say 201 s
  EXPECT_LT(left_after(490, part), 15);
}

TEST(TimeLeft, IsNotSaidUntilThereIsARate) {
  EXPECT_EQ(left_after(0, [](double) { return 0.4; }), -1);
  EXPECT_EQ(left_after(1, [](double t) { return 0.1 * t; }), -1);
  EXPECT_EQ(left_after(100, [](double) { return 0.4; }), -1);  // what a resumed run begins with is no rate
  EXPECT_NEAR(left_after(20, [](double t) { return 0.4 + 0.01 * t; }), 40, 1);
}

TEST(TimeLeft, GrowsWhileNothingIsDone) {
  const auto part = [](double t) { return std::min(t, 50.0) / 100; };
  EXPECT_GT(left_after(100, part), 80);
  EXPECT_GT(left_after(150, part), left_after(100, part));
}

TEST(MachineLoad, ReadsTheKernelsCounters) {
  const auto times = cpu_times_of("cpu  100 20 30 500 50 5 5 10 7 0", 100, 0.5);
  ASSERT_TRUE(times);
  EXPECT_DOUBLE_EQ(times->all, 7.2);  // a guest's time is in the user's
  EXPECT_DOUBLE_EQ(times->busy, 1.7);
  EXPECT_DOUBLE_EQ(times->own, 0.5);
  for (const char* line : {"", "cpu", "cpu0 1 2 3 4 5 6 7 8", "cpu 1 2 3", "intr 1 2 3 4 5 6 7 8"})
    EXPECT_FALSE(cpu_times_of(line, 100, 0)) << line;
  EXPECT_FALSE(cpu_times_of("cpu  100 20 30 500 50 5 5 10", 0, 0));
}

TEST(MachineLoad, TellsOfOthersWhereTheyTakeMuchAndLeaveNoRoom) {
  const CpuTimes from{1000, 400, 50};
  EXPECT_EQ(crowd_line(from, {1100, 498, 58}), "other programs take 90 % of this machine: this takes longer");
  EXPECT_EQ(crowd_line(from, {1100, 500, 149}), "");  // all of it is this program's
  EXPECT_EQ(crowd_line(from, {1100, 500, 110}), "");  // 40 %
  EXPECT_EQ(crowd_line(from, {1100, 480, 60}), "");   // cores are idle
  EXPECT_EQ(crowd_line(from, {1001, 401, 50}), "");   // too near
  EXPECT_EQ(crowd_line(from, from), "");
  EXPECT_DOUBLE_EQ(part_of_others(from, {1100, 450, 120}).value(), 0.0);  // counters of two clocks: never below 0
}

std::string printed(ProgressOptions options) {
  std::FILE* stream = std::tmpfile();
  options.to = stream;
  {
    Progress progress("fit", options);
    for (int i = 1; i <= 4; ++i) progress.update(0.25 * i, 0);
  }
  std::rewind(stream);
  std::string text(4096, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream));
  std::fclose(stream);
  return text;
}

TEST(Progress, IsSilentAtFirstAndWhenQuiet) {
  EXPECT_EQ(printed({}), "");
  EXPECT_EQ(printed({.quiet = true, .first_after = 0.0, .every_plain = 0.0}), "");
}

TEST(Progress, IsThrottledAndPlainWhereThereIsNoTerminal) {
  EXPECT_EQ(printed({.first_after = 0.0, .every_plain = 1000.0}).substr(0, 9), "fit: 25 %");
  const std::string text = printed({.first_after = 0.0, .every_plain = 1000.0});
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
  EXPECT_EQ(text.find('\r'), std::string::npos);
}

TEST(Progress, LeavesATerminalsLineClear) {
  EXPECT_TRUE(printed({.terminal = true, .first_after = 0.0, .every_terminal = 0.0}).ends_with("\r\033[K"));
}

}  // namespace
}  // namespace servodx
