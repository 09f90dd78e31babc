#include "base/meeting.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>

namespace servodx {
namespace {

struct Question {
  int asked = 0, answer = 0;
};

TEST(Meeting, IsServedOnceAllThatLiveWaitInTheOrderOfTheRuns) {
  constexpr int runs = 7;  // run k asks k + 1 times
  std::vector<std::vector<int>> rounds;
  std::vector<int> sums(runs);
  Meeting<Question>::hold(
      runs, runs,
      [&](int run, const Meeting<Question>::Ask& ask) {
        for (int k = 0; k <= run; ++k) {
          Question q{100 * run + k};
          ask(q);
          sums[static_cast<std::size_t>(run)] += q.answer;
        }
      },
      [&](const std::vector<Question*>& questions) {
        rounds.emplace_back();
        for (Question* q : questions) rounds.back().push_back(q->asked), q->answer = q->asked + 1;
      });
  ASSERT_EQ(rounds.size(), static_cast<std::size_t>(runs));
  for (int k = 0; k < runs; ++k) {
    std::vector<int> expected;
    for (int run = k; run < runs; ++run) expected.push_back(100 * run + k);
    EXPECT_EQ(rounds[static_cast<std::size_t>(k)], expected);
  }
  for (int run = 0; run < runs; ++run) {
    int sum = 0;
    for (int k = 0; k <= run; ++k) sum += 100 * run + k + 1;
    EXPECT_EQ(sums[static_cast<std::size_t>(run)], sum);
  }
}

TEST(Meeting, NoMoreWorkThanPlacesAtATimeAndNoneWhileItServes) {
  for (const int places : {1, 2, 3}) {
    std::atomic<int> at_work = 0, most = 0;
    const auto work = [&] {
      const int now = ++at_work;
      int seen = most;
      while (seen < now && !most.compare_exchange_weak(seen, now)) {
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      --at_work;
    };
    Meeting<Question>::hold(
        12, places,
        [&](int, const Meeting<Question>::Ask& ask) {
          for (int k = 0; k < 5; ++k) {
            work();
            Question q;
            ask(q);
          }
          work();
        },
        [&](const std::vector<Question*>&) { EXPECT_EQ(at_work, 0); });
    EXPECT_EQ(most, places);
  }
}

TEST(Meeting, AnExceptionOfARunIsThrownWhenTheOthersHaveEnded) {
  int ended = 0;
  const auto hold = [&] {
    Meeting<Question>::hold(
        5, 1,
        [&](int run, const Meeting<Question>::Ask& ask) {
          Question q;
          ask(q);
          if (run >= 3) throw std::runtime_error("run " + std::to_string(run));
          ask(q);
          ++ended;
        },
        [](const std::vector<Question*>&) {});
  };
  try {
    hold();
    FAIL();
  } catch (const std::runtime_error& e) {
    EXPECT_STREQ(e.what(), "run 3");
  }
  EXPECT_EQ(ended, 3);
}

TEST(Meeting, AnExceptionOfTheServiceEndsAllRuns) {
  std::atomic<int> ended = 0;
  EXPECT_THROW(Meeting<Question>::hold(
                   6, 2,
                   [&](int, const Meeting<Question>::Ask& ask) {
                     Question q;
                     ask(q);
                     ++ended;
                   },
                   [](const std::vector<Question*>&) { throw std::logic_error("closed"); }),
               std::logic_error);
  EXPECT_EQ(ended, 0);
}

}  // namespace
}  // namespace servodx
