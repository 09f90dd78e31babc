// A fault is as visible as on the log that shows it best.
#include "diagnose/best_seen.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "servodx/check_log.h"

namespace servodx {
namespace {

Promise promise(double at_least, double at_typical) {
  Promise p;
  p.faults = {{"a_fault", "-", 0.1, 0.5, at_least, at_typical}};
  return p;
}

TEST(BestSeen, AFaultShowsAsOnTheLogThatShowsItBest) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::vector<Promise> logs;
    double at_least, at_typical;
  };
  for (const Case& c : {Case{{promise(1, 5)}, 1, 5}, Case{{promise(1, 5), promise(2, 4)}, 2, 5},
                        Case{{promise(nan, 4), promise(2, nan)}, 2, 4}, Case{{promise(nan, nan)}, 0, 0}}) {
    const std::vector<Visible> best = best_seen(c.logs);
    ASSERT_EQ(best.size(), 1u);
    EXPECT_EQ(best[0].fault, "a_fault");
    EXPECT_EQ(best[0].deviates_at_least, c.at_least);
    EXPECT_EQ(best[0].deviates_at_typical, c.at_typical);
  }
  EXPECT_TRUE(best_seen({}).empty());
}

}  // namespace
}  // namespace servodx
