#include "base/checkpoint.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "base/atomic_file.h"
#include "base/bytes.h"
#include "base/csv.h"
#include "base/stages.h"
#include "servodx/checkpoint.h"
#include "servodx/error.h"
#include "servodx/watch.h"
#include "temporary_folder.h"

namespace servodx {

struct Part {
  std::string name;
  std::vector<double> numbers;
  std::optional<int> count;
  std::map<std::string, double> by_name;
  bool set = false;
};
inline auto fields(Part& p) {
  auto& [name, numbers, count, by_name, set] = p;
  return std::tie(name, numbers, count, by_name, set);
}

namespace {

Part a_part() {
  return {"a name", {1.0 / 3, -0.0, std::nan("7"), std::numeric_limits<double>::infinity()}, 4, {{"b", 1e-320}}, true};
}

std::shared_ptr<Checkpoint> opened(const std::string& path, CheckpointUse use, const std::string& build = "one") {
  return std::make_shared<Checkpoint>(path, use, build);
}

Watch watch_with(std::shared_ptr<Checkpoint> checkpoint, std::function<bool()> stop = {}) {
  return {.stop = std::move(stop), .checkpoint = std::move(checkpoint)};
}

TEST(Bytes, ComeBackToTheBit) {
  const std::string bytes = to_bytes(std::vector<Part>{a_part(), {}});
  const auto back = from_bytes<std::vector<Part>>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(to_bytes(*back), bytes);
  EXPECT_TRUE(std::signbit((*back)[0].numbers[1]));
  EXPECT_EQ((*back)[0].by_name.at("b"), 1e-320);
}

TEST(Bytes, WhatIsNotOneWholeValueIsNone) {
  const std::string bytes = to_bytes(a_part());
  for (std::size_t n = 0; n < bytes.size(); ++n) EXPECT_FALSE(from_bytes<Part>(bytes.substr(0, n))) << n;
  EXPECT_FALSE(from_bytes<Part>(bytes + "x"));
}

// A length of 2^60 asks for no memory.
TEST(Bytes, ALengthIsNotBelieved) {
  std::string bytes = to_bytes(std::uint64_t{1} << 60);
  bytes += "abc";
  EXPECT_FALSE(from_bytes<std::vector<double>>(bytes));
  EXPECT_FALSE(from_bytes<std::string>(bytes));
}

TEST(Checkpoint, WhatIsKeptIsFoundByTheNextRun) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", key(64, 'a'), other(64, 'b');
  {
    const auto first = opened(path, CheckpointUse::begin);
    EXPECT_FALSE(first->find(key));
    first->keep(key, "one");
    first->keep(other, std::string("\0two\n", 5));
    first->keep(key, "later");
    EXPECT_EQ(first->report().kept, 3);
  }
  const auto second = opened(path, CheckpointUse::go_on);
  EXPECT_EQ(second->find(key), "later");
  EXPECT_EQ(second->find(other), std::string("\0two\n", 5));
  EXPECT_EQ(second->report().taken, 2);
  EXPECT_EQ(second->report().trouble, "");
}

TEST(Checkpoint, WithoutGoingOnItBeginsAnew) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", key(64, 'a');
  opened(path, CheckpointUse::begin)->keep(key, "one");
  EXPECT_FALSE(opened(path, CheckpointUse::begin)->find(key));
  EXPECT_FALSE(opened(path, CheckpointUse::go_on)->find(key));
}

// Wherever a kill cuts it: the stages before are found, the cut one is not, and what is kept then is found again.
TEST(Checkpoint, ACutStageIsLeftOutAndNoOther) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", a(64, 'a'), b(64, 'b'), c(64, 'c');
  {
    const auto whole = opened(path, CheckpointUse::begin);
    whole->keep(a, "the first"), whole->keep(b, "the second");
  }
  const std::string bytes = read_file(path);
  const std::size_t first = bytes.find("stage " + b);
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    write_file(path, bytes.substr(0, n));
    {
      const auto cut = opened(path, CheckpointUse::go_on);
      EXPECT_EQ(cut->find(a).has_value(), n >= first) << n;
      EXPECT_FALSE(cut->find(b)) << n;
      cut->keep(c, "more");
    }
    EXPECT_EQ(opened(path, CheckpointUse::go_on)->find(c), "more") << n;
  }
}

TEST(Checkpoint, AChangedByteIsNotBelieved) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", a(64, 'a'), b(64, 'b');
  {
    const auto whole = opened(path, CheckpointUse::begin);
    whole->keep(a, "the first"), whole->keep(b, "the second");
  }
  const std::string bytes = read_file(path);
  for (std::size_t n = bytes.find("stage " + b); n < bytes.size(); ++n) {
    std::string changed = bytes;
    changed[n] ^= 1;
    write_file(path, changed);
    const auto damaged = opened(path, CheckpointUse::go_on);
    EXPECT_EQ(damaged->find(a), "the first") << n;
    EXPECT_FALSE(damaged->find(b)) << n;
    EXPECT_NE(damaged->report().trouble.find("left out"), std::string::npos) << n;
  }
}

TEST(Checkpoint, AFileThatIsNoneIsRefusedAndStays) {
  const TemporaryFolder folder;
  const std::string path = folder / "log.csv";
  write_file(path, "time [s],command [mA]\n");
  EXPECT_THROW(opened(path, CheckpointUse::go_on), InputError);
  EXPECT_EQ(read_file(path), "time [s],command [mA]\n");
  EXPECT_THROW(opened(folder / "missing", CheckpointUse::go_on), InputError);
  EXPECT_FALSE(std::filesystem::exists(folder / "missing"));
  EXPECT_THROW(opened(folder.path.string(), CheckpointUse::go_on), InputError);
  EXPECT_THROW(opened("/dev/null", CheckpointUse::begin), InputError);
}

TEST(Checkpoint, TwoRunsDoNotShareOne) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", key(64, 'a');
  const auto first = opened(path, CheckpointUse::begin);
  first->keep(key, "one");
  EXPECT_THROW(opened(path, CheckpointUse::go_on), InputError);
  EXPECT_THROW(opened(path, CheckpointUse::begin), InputError);
  EXPECT_NE(read_file(path).find("one"), std::string::npos);
}

// As on a disk that is full: the run goes on, and the file stays sound.
TEST(Checkpoint, WhatCannotBeWrittenIsTakenBack) {
  const TemporaryFolder folder;
  const std::string path = folder / "kept", a(64, 'a'), b(64, 'b');
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  {
    const auto full = opened(path, CheckpointUse::begin);
    full->keep(a, "one");
    const auto old = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{500, before.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &small);
    full->keep(b, std::string(1000, 'x'));
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, old);
    EXPECT_NE(full->report().trouble.find("no more is kept"), std::string::npos);
    full->keep(b, "later");
    EXPECT_EQ(full->report().kept, 1);
  }
  const auto next = opened(path, CheckpointUse::go_on);
  EXPECT_EQ(next->report().trouble, "");
  EXPECT_EQ(next->find(a), "one");
  EXPECT_FALSE(next->find(b));
}

TEST(Stages, AStageIsMadeOnce) {
  const TemporaryFolder folder;
  int made = 0;
  const auto call = [&](CheckpointUse use, const std::string& build, double input) {
    const Stages stages(watch_with(opened(folder / "kept", use, build)), "call", std::string("log"));
    return stages
        .made(
            "stage",
            [&] {
              return ++made, Part{"made", {input}};
            },
            input)
        .numbers[0];
  };
  EXPECT_EQ(call(CheckpointUse::begin, "one", 0.1), 0.1);
  EXPECT_EQ(call(CheckpointUse::go_on, "one", 0.1), 0.1);
  EXPECT_EQ(made, 1);
  EXPECT_EQ(call(CheckpointUse::go_on, "one", 0.2), 0.2);  // another input
  EXPECT_EQ(made, 2);
  EXPECT_EQ(call(CheckpointUse::go_on, "two", 0.1), 0.1);  // another build
  EXPECT_EQ(made, 3);
  EXPECT_EQ(call(CheckpointUse::go_on, "one", 0.1), 0.1);  // that of the first is still there
  EXPECT_EQ(made, 3);
}

TEST(Stages, ThoseOfAnotherPartAreOthers) {
  const TemporaryFolder folder;
  const auto of_log = [&](CheckpointUse use, int log, int made) {
    const Stages all(watch_with(opened(folder / "kept", use)), "call");
    return all.part("log", log).made("stage", [&] { return made; });
  };
  EXPECT_EQ(of_log(CheckpointUse::begin, 1, 10), 10);
  EXPECT_EQ(of_log(CheckpointUse::go_on, 2, 20), 20);
  EXPECT_EQ(of_log(CheckpointUse::go_on, 1, 30), 10);
}

TEST(Stages, WhatAStopHasCutShortIsNotKept) {
  const TemporaryFolder folder;
  bool stopped = false;
  const auto checkpoint = opened(folder / "kept", CheckpointUse::begin);
  const Stages stages(watch_with(checkpoint, [&] { return stopped; }), "call");
  EXPECT_EQ(stages.made("stage", [&] { return stopped = true, 1; }), 1);
  EXPECT_EQ(checkpoint->report().kept, 0);
  stopped = false;
  EXPECT_EQ(stages.made("stage", [] { return 2; }), 2);
}

TEST(Stages, WithoutACheckpointAllIsMade) {
  int made = 0;
  const Stages none;
  for (int i = 0; i < 2; ++i) none.made("stage", [&] { return ++made; });
  EXPECT_EQ(made, 2);
}

TEST(BuildIdentity, IsThatOfThisProgram) {
  EXPECT_EQ(build_identity(), build_identity());
  EXPECT_EQ(build_identity().size(), 40u);  // as this project is linked
}

}  // namespace
}  // namespace servodx
