// The rules of the cause and of the life that counts, on made-up evidence: no fit, no history.
#include "prognose/cause_rule.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "prognose/life.h"

namespace servodx {
namespace {

struct Case {
  std::string name;
  std::vector<CauseEvidence> checks;  // tracked, predicted, surely, log Bayes factor
  std::optional<std::size_t> cause;
};

const std::vector<Case> cases = {
    {"no checks", {}, {}},
    {"one parameter that grows", {{true, true, 0.5, 10}}, 0},
    {"a paper's check names no cause", {{false, true, 0.9, 50}}, {}},
    {"a parameter without a life is none", {{true, false, 0.9, 50}}, {}},
    {"of two as far, the more certain", {{true, true, 0.5, 10}, {true, true, 0.5, 20}}, 1},
    {"of two alike, the first", {{true, true, 0.5, 10}, {true, true, 0.5, 10}}, 0},
    {"more certain, but not half as far", {{true, true, 0.8, 10}, {true, true, 0.39, 90}}, 0},
    {"more certain, and half as far", {{true, true, 0.8, 10}, {true, true, 0.4, 90}}, 1},
    {"the furthest need not be the cause", {{true, true, 0.8, 10}, {true, true, 0.5, 11}, {true, true, 0.6, 90}}, 2},
    {"what a paper's check has come bars nobody", {{false, true, 9, 90}, {true, true, 0.1, 5}}, 1},
    {"where none has surely come any way, the furthest", {{true, true, -0.2, 10}, {true, true, -0.1, 5}}, 1},
};

TEST(CauseRule, EachCaseIsNamedAsTheRulesSay) {
  for (const Case& c : cases) EXPECT_EQ(cause_of(c.checks), c.cause) << c.name;
}

TEST(CauseRule, ASharpLifeOutweighsAWideOne) {
  Life sharp, wide;
  for (int k = 0; k < 200; ++k) sharp.push_back(100 + 0.05 * k), wide.push_back(10.0 * k);
  EXPECT_NEAR(life_quantile(pooled({&sharp, &wide}, 0.9), 0.5), life_quantile(sharp, 0.5), 1);
  EXPECT_GT(life_quantile(pooled({&wide}, 0.9), 0.5), 900);
}

}  // namespace
}  // namespace servodx
