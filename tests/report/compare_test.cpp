// What differs between two results that may explain what they say.
#include "report/compare/compare.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "report/shared/json.h"

namespace servodx::report {
namespace {

Json result(const Json& more) {
  Json out = {{"schema", 1},
              {"command", "diagnose"},
              {"version", "1.0.0"},
              {"seed", 1},
              {"inputs", Json::array()},
              {"settings", Json::object()},
              {"results", Json::array()}};
  out.update(more);
  return out;
}

TEST(Compare, CommitsAreACauseOnlyWhereBothResultsStateOne) {
  const Json plain = result(Json::object()), of_one = result({{"commit", "aaaa"}}),
             of_another = result({{"commit", "bbbb"}});
  EXPECT_TRUE(compare("a", of_one, "b", plain).conditions.empty());
  EXPECT_TRUE(compare("a", of_one, "b", of_one).conditions.empty());
  const auto differ = compare("a", of_one, "b", of_another).conditions;
  ASSERT_EQ(differ.size(), 1u);
  EXPECT_EQ(differ.front(), "commit: aaaa and bbbb");
}

TEST(Compare, VersionsAndSeedsThatDifferAreConditions) {
  EXPECT_EQ(compare("a", result(Json::object()), "b", result({{"seed", 2}})).conditions.size(), 1u);
  EXPECT_EQ(compare("a", result(Json::object()), "b", result({{"version", "1.0.1"}})).conditions.size(), 1u);
}

}  // namespace
}  // namespace servodx::report
