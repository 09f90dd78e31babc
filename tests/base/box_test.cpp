// What the box is for, without a file of a log: each way to end badly is an answer.
#include "base/box.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <functional>
#include <string>

#include "temporary_folder.h"

namespace servodx {
namespace {

const BoxLimits small{.memory = std::size_t{64} << 20, .seconds = 1};

TEST(Box, ACrashALoopAndAHungerForMemoryEndTheChildAlone) {
  const auto ended = [](const std::function<void(const Box::Give&)>& work) {
    Box box(small, work);
    char byte = 0;
    while (box.take(&byte, 1)) {
    }
    return box.end();
  };
  EXPECT_EQ(ended([](const Box::Give& give) { give("all"); }), BoxEnd::whole);
  EXPECT_EQ(ended([](const Box::Give&) { __builtin_trap(); }), BoxEnd::crashed);
  EXPECT_EQ(ended([](const Box::Give& give) { give(std::string(std::size_t{1} << 30, 'x')); }), BoxEnd::out_of_memory);
  EXPECT_EQ(ended([](const Box::Give&) {
              for (volatile bool more = true; more;) {
              }
            }),
            BoxEnd::out_of_time);
}

TEST(Box, WhatTheChildGivesArrivesWhole) {
  const std::string long_text(std::size_t{3} << 20, 'a');
  Box box({.memory = std::size_t{64} << 20, .seconds = 5}, [&](const Box::Give& give) {
    give("head");
    give(long_text);
  });
  std::string head(4, ' '), all(long_text.size(), ' ');
  EXPECT_TRUE(box.take(head.data(), head.size()) && box.take(all.data(), all.size()));
  EXPECT_EQ(head, "head");
  EXPECT_EQ(all, long_text);
  EXPECT_FALSE(box.take(head.data(), 1));
  EXPECT_EQ(box.end(), BoxEnd::whole);
}

struct Call {
  const char* name;
  void (*make)();
};
void PrintTo(const Call& call, std::ostream* to) { *to << call.name; }

// Descriptors as they are in the parent: what it has open is not the child's.
constexpr Call forbidden[] = {
    {"Socket", [] { ::socket(AF_INET, SOCK_STREAM, 0); }},
    {"SignalToTheParent", [] { ::kill(::getppid(), 0); }},
    {"NewProcess", [] { ::fork(); }},
    {"Program", [] { ::execl("/bin/true", "true", nullptr); }},
    {"Removal", [] { ::unlink("/nowhere/at/all"); }},
    {"NewName", [] { ::rename("/nowhere/at/all", "/nowhere/else"); }},
    {"NewCode", [] { ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0); }},
    {"WriteToAFile", [] { [[maybe_unused]] const ssize_t n = ::write(40, "x", 1); }},
    {"NewHandlerOfForbiddenCalls", [] { ::signal(SIGSYS, SIG_IGN); }},
    {"HigherLimit",
     [] {
       struct rlimit more {};
       ::setrlimit(RLIMIT_AS, &more);
     }},
};

class ForbiddenCall : public testing::TestWithParam<Call> {};

TEST_P(ForbiddenCall, EndsTheChild) {
  Box box(small, [](const Box::Give& give) {
    GetParam().make();
    give("it went on");
  });
  if (!box.filters_calls()) GTEST_SKIP() << "this system refuses filters of system calls";
  char byte = 0;
  EXPECT_FALSE(box.take(&byte, 1));
  EXPECT_EQ(box.end(), BoxEnd::forbidden_call);
}

INSTANTIATE_TEST_SUITE_P(OfTheSystem, ForbiddenCall, testing::ValuesIn(forbidden),
                         [](const testing::TestParamInfo<Call>& call) { return call.param.name; });

TEST(Box, OneFileOpensAsOftenAsItIsAskedForAndNoOther) {
  const TemporaryFolder folder;
  BoxLimits limits = small;
  limits.file = folder.write("log", "head");
  const std::string other = folder.write("other", "secret");
  Box box(limits, [&](const Box::Give& give) {
    for (int times = 0; times < 2; ++times) {
      std::string text(4, ' ');
      std::FILE* file = std::fopen(limits.file.c_str(), "rb");
      if (!file || std::fread(text.data(), 1, text.size(), file) != text.size()) text = "none";
      if (file) std::fclose(file);
      give(text);
    }
    for (const char* name : {other.c_str(), "/etc/passwd", "/proc/self/mem"})
      for (const int how : {O_RDONLY, O_RDWR, O_WRONLY | O_CREAT}) give(::open(name, how, 0600) < 0 ? "no" : "ok");
  });
  if (!box.filters_calls()) GTEST_SKIP() << "this system refuses filters of system calls";
  std::string got(2 * 4 + 9 * 2, ' ');
  EXPECT_TRUE(box.take(got.data(), got.size()));
  EXPECT_EQ(got, "headheadnonononononononono");
  EXPECT_EQ(box.end(), BoxEnd::whole);
}

TEST(Box, WhatIsPreparedIsNotLimited) {
  const TemporaryFolder folder;
  const std::string other = folder.write("other", "text");
  int file = -1;
  Box box(
      small,
      [&](const Box::Give& give) {
        char first = ' ';
        give(::read(file, &first, 1) == 1 ? "read" : "none");
      },
      [&] { file = ::open(other.c_str(), O_RDONLY); });
  std::string got(4, ' ');
  EXPECT_TRUE(box.take(got.data(), got.size()));
  EXPECT_EQ(got, "read");
}

}  // namespace
}  // namespace servodx
