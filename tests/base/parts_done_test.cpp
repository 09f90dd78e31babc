#include "base/parts_done.h"

#include <gtest/gtest.h>

#include <vector>

#include "servodx/watch.h"

namespace servodx {
namespace {

TEST(PartsDone, TellsTheMeanOfItsPartsAndTheSumOfTheirSimulations) {
  std::vector<WorkDone> told;
  const Watch watch{.progress = [&](const WorkDone& done) { told.push_back(done); }};
  PartsDone parts(watch, "baseline", 4);
  parts.tell(2, 0.5, 10);
  const Watch of_first = parts.of(0);
  of_first.tell("assess", 1.0, 7);  // by its own name for the work
  parts.tell(2, 1.0, 30);
  ASSERT_EQ(told.size(), 3u);
  EXPECT_EQ(told[0].part, 0.125);
  EXPECT_EQ(told[1].part, 0.375);
  EXPECT_EQ(told[2].part, 0.5);
  EXPECT_EQ(told[1].simulations, 17);
  EXPECT_EQ(told[2].simulations, 37);
  for (const WorkDone& done : told) EXPECT_EQ(done.work, "baseline");
}

TEST(PartsDone, PartsStopAsTheWholeDoesAndTellNothingWhereNothingIsToldOfTheWhole) {
  bool stop = false;
  const Watch watch{.stop = [&] { return stop; }};
  PartsDone parts(watch, "diagnose", 2);
  const Watch of_second = parts.of(1);
  EXPECT_FALSE(of_second.progress);
  EXPECT_FALSE(of_second.stopped());
  stop = true;
  EXPECT_TRUE(of_second.stopped());
}

}  // namespace
}  // namespace servodx
