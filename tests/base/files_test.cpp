#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/progress.h"
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
  EXPECT_EQ(progress_line("tune", 0.5, 1000, 10.0), "tune: 50 %, 100 evaluations/s, 10 s left");
  EXPECT_EQ(progress_line("tune", 0.25, 30, 20.0), "tune: 25 %, 1.5 evaluations/s, 1 min 0 s left");
  EXPECT_EQ(progress_line("tune", 0.0, 0, 2.0), "tune: 0 %");
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
