// Late, missing and repeated samples.
#include "online/arrivals.h"

#include <gtest/gtest.h>

#include <vector>

#include "signals/sample.h"

namespace servodx {
namespace {

struct Given {
  std::vector<double> times;
  ArrivalCounts counts;
};

Given given(const std::vector<double>& milliseconds) {
  Arrivals arrivals;
  Given out;
  const auto drain = [&] {
    for (const Sample& s : arrivals.take()) out.times.push_back(s.time * 1e3);
  };
  for (double t : milliseconds) {
    Sample s;
    s.time = t * 1e-3;
    if (arrivals.add(s)) drain();
  }
  drain();
  out.counts = arrivals.counts;
  return out;
}

TEST(Arrivals, ASampleThatIsLateWithinItsPartFindsItsPlace) {
  const Given g = given({0, 1, 3, 2, 4});
  EXPECT_EQ(g.times, (std::vector<double>{0, 1, 2, 3, 4}));
  EXPECT_EQ(g.counts.late, 0);
}

TEST(Arrivals, ASampleOfAPartThatIsGoneIsCounted) {
  std::vector<double> times;
  for (int k = 0; k <= 10; ++k) times.push_back(k);
  times.push_back(4.5);
  times.push_back(11);
  const Given g = given(times);
  EXPECT_EQ(g.times.size(), 12u);
  EXPECT_EQ(g.counts.late, 1);
}

TEST(Arrivals, ARepeatedTimeIsKeptOnce) {
  const Given g = given({0, 1, 1, 2, 0});
  EXPECT_EQ(g.times, (std::vector<double>{0, 1, 2}));
  EXPECT_EQ(g.counts.repeated, 2);
}

TEST(Arrivals, AWrongTimeFarAheadDoesNotEndTheWatch) {
  std::vector<double> times = {0, 1, 1e9};
  for (int k = 2; k < 1000; ++k) times.push_back(k);
  const Given g = given(times);
  EXPECT_EQ(g.times.back(), 999);
  EXPECT_GT(g.times.size(), 700u);
}

TEST(Arrivals, APartIsTenMillisecondsAtAnyRate) {
  Arrivals arrivals;
  int parts = 0;
  for (int k = 0; k <= 1000; ++k) {
    Sample s;
    s.time = 1e-3 * k;
    if (!arrivals.add(s)) continue;
    ++parts;
    EXPECT_LE(arrivals.take().size(), 11u);
  }
  EXPECT_EQ(parts, 100);
}

}  // namespace
}  // namespace servodx
