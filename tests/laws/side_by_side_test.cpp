#include "simulate/side_by_side.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace servodx {
namespace {

TEST(SideBySide, EachPieceIsDoneOnceAndTheThreadsAreSharedOut) {
  for (const int threads : {1, 2, 5}) {
    std::vector<int> done(7), threads_of(7);
    side_by_side(7, threads, [&](int piece, int threads_of_it) {
      ++done[static_cast<std::size_t>(piece)];
      threads_of[static_cast<std::size_t>(piece)] = threads_of_it;
    });
    EXPECT_EQ(done, std::vector<int>(7, 1)) << threads;
    EXPECT_EQ(threads_of, std::vector<int>(7, 1)) << threads;
  }
  std::vector<int> threads_of(2);
  side_by_side(2, 6, [&](int piece, int of_it) { threads_of[static_cast<std::size_t>(piece)] = of_it; });
  EXPECT_EQ(threads_of, std::vector<int>(2, 3));
}

TEST(SideBySide, ManyAreAtWorkAtOnce) {
  std::atomic<int> begun = 0, met = 0;
  side_by_side(2, 2, [&](int, int) {
    ++begun;
    while (begun < 2) std::this_thread::yield();  // without end where they begin one after another
    ++met;
  });
  EXPECT_EQ(met, 2);
}

// Says on a thread's end that it has failed and so begins no other piece.
struct Ended {
  std::atomic<bool>* told = nullptr;
  ~Ended() {
    if (told) *told = true;
  }
};
thread_local Ended ended;

TEST(SideBySide, ThrowsWhatTheFirstPieceThatFailedHasThrownAndBeginsNoMore) {
  for (const int threads : {1, 3}) {
    std::vector<int> begun(50);
    std::atomic<bool> over = false;
    const auto failing = [&](int piece, int) {
      begun[static_cast<std::size_t>(piece)] = 1;
      if (piece == 2 || piece == 3) {
        if (threads > 1) ended.told = &over;
        throw std::runtime_error(std::to_string(piece));
      }
      // What was begun beside a failure lasts until that is over, on a busy machine too.
      while (piece > 3 && !over) std::this_thread::yield();
    };
    try {
      side_by_side(50, threads, failing);
      FAIL() << "nothing was thrown";
    } catch (const std::runtime_error& failure) {
      EXPECT_STREQ(failure.what(), "2");
    }
    int pieces = 0;
    for (const int b : begun) pieces += b;
    EXPECT_LE(pieces, 2 + threads) << "0, 1, 2 and one beside it for each other thread";
  }
}

}  // namespace
}  // namespace servodx
