// What ranks of healthy scores promise, on paper.
#include "evidence/rank_promise.h"

#include <gtest/gtest.h>

#include <cmath>

#include "evidence/probabilities.h"

namespace servodx {
namespace {

TEST(RankPromise, TheThresholdIsTheScoreThatKeepsTheRate) {
  struct Case {
    std::vector<double> scores;
    double asked, threshold, promised;
    int needed;
    bool kept;
  };
  for (const Case& c : {Case{{2, 1, 3}, 0.01, 3, 1.0 / 4, 99, false},  // three logs promise no less
                        Case{{2, 1, 3}, 0.25, 3, 1.0 / 4, 3, true},    // and this just
                        Case{{2, 1, 3}, 0.5, 2, 2.0 / 4, 1, true},     // two of four may lie above
                        Case{{5, 5, 5, 5}, 0.2, 5, 1.0 / 5, 4, true}}) {
    const RankPromise p = rank_promise(c.scores, c.asked);
    EXPECT_EQ(p.threshold, c.threshold) << c.asked;
    EXPECT_DOUBLE_EQ(p.promised, c.promised) << c.asked;
    EXPECT_DOUBLE_EQ(p.promised_95, 1 - std::pow(0.05, 1.0 / static_cast<double>(c.scores.size())));
    EXPECT_EQ(p.logs_needed, c.needed) << c.asked;
    EXPECT_EQ(promise_kept(p.promised, c.asked), c.kept) << c.asked;
  }
}

TEST(RankPromise, PValueCountsTheHealthyScoresAtOrAbove) {
  for (const auto& [score, p] : {std::pair{0.5, 1.0}, {1.5, 0.75}, {2.0, 0.75}, {3.0, 0.5}, {9.0, 0.25}})
    EXPECT_DOUBLE_EQ(rank_p_value(score, {1, 2, 3}), p) << score;
}

TEST(Probabilities, TheScaleTempersAndThePriorWeighs) {
  EXPECT_DOUBLE_EQ(misfit_inflation(50, 100), 1);  // better than expected is no better than expected
  EXPECT_DOUBLE_EQ(misfit_inflation(300, 100), 3);
  EXPECT_DOUBLE_EQ(misfit_scale(1000, 100, 100, 0.1), 1 + 0.01 * 9);
  EXPECT_DOUBLE_EQ(misfit_scale(100, 100, 100, 0.1), 1);
  const auto p = probabilities_of({{1, 10}, {1, 10}, {0.5, 10}}, 1);
  EXPECT_DOUBLE_EQ(p[0], 0.4);
  EXPECT_DOUBLE_EQ(p[2], 0.2);
  const auto q = probabilities_of({{1, 14}, {1, 10}}, 2);
  EXPECT_DOUBLE_EQ(q[0] / q[1], std::exp(-1.0));
}

}  // namespace
}  // namespace servodx
