// The rules that end an explanation, on made-up evidence: each row changes one thing.
#include "explain/verdict.h"

#include <gtest/gtest.h>

#include "explain/outcome.h"

namespace servodx {
namespace {

constexpr double level = 0.02;

EndEvidence compared(std::size_t causes, double share_of_first, double chance_left) {
  EndEvidence e;
  e.compared = true, e.level = level;
  e.causes = causes, e.share_of_first = share_of_first, e.chance_left = chance_left;
  return e;
}

EndEvidence alone(std::size_t causes, double over_noise, double block_misses) {
  EndEvidence e;
  e.causes = causes, e.over_noise = over_noise, e.block_misses = block_misses;
  return e;
}

TEST(ExplainVerdict, EachCaseOfTheTable) {
  EndEvidence curve = compared(1, 0.9, 0.5), blocks = compared(1, 0.1, level / 4);
  curve.curve = true, blocks.told_by_blocks = true;
  struct Case {
    const char* what;
    EndEvidence evidence;
    ExplainVerdict verdict;
  };
  using enum ExplainVerdict;
  const Case cases[] = {
      {"nothing new", compared(0, 0, 0.5), sufficient},
      {"a name", compared(1, 0.9, 0.5), extended},
      {"a name of which most is left, within health", compared(1, 0.1, 0.5), extended},
      {"left abnormal without a name", compared(0, 0, level / 2), unexplained},
      {"left abnormal by a name that removes little", compared(1, 0.49, level / 2), unexplained},
      {"left abnormal by a name that removes half", compared(1, 0.5, level / 2), extended},
      {"a curve", curve, unexplained},
      {"left abnormal, but the blocks tell a name", blocks, extended},
      {"alone, near the noise", alone(0, 2.9, 0.9), sufficient},
      {"alone, far from the noise, and the blocks follow", alone(0, 11, 0.1), sufficient},
      {"alone, far from the noise, and a block misses", alone(0, 11, 0.23), unexplained},
      {"the same with a name", alone(1, 11, 0.23), extended},
  };
  for (const Case& c : cases) EXPECT_EQ(verdict_of(c.evidence), c.verdict) << c.what;
}

}  // namespace
}  // namespace servodx
