// Failure levels in a user's words, and what there is, in words of the front door.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "servodx/error.h"
#include "servodx/history.h"
#include "servodx/lists.h"
#include "servodx/log.h"
#include "servodx/trend.h"

namespace servodx {
namespace {

TEST(FailureLevels, AreReadAsTheyAreMeant) {
  const auto is = [](const std::string& words, const std::string& check, FailureLevel::Kind kind, double value) {
    const FailureLevel level = failure_level(words);
    EXPECT_EQ(level.check, check) << words;
    EXPECT_EQ(level.kind, kind) << words;
    EXPECT_EQ(level.value, value) << words;
  };
  is("fidelity=1.7", "fidelity", FailureLevel::Kind::above, 1.7);
  is("parameter:3=<20", "parameter:3", FailureLevel::Kind::below, 20);
  is("parameter:14=20x", "parameter:14", FailureLevel::Kind::times_healthy, 20);
  is("parameter:14=0.9e-3A", "parameter:14", FailureLevel::Kind::current, 0.9e-3);
  EXPECT_FALSE(failure_level("fidelity=1.7").spread);
  EXPECT_EQ(failure_level("parameter:22=30e-6~1e-6").spread, 1e-6);
}

TEST(FailureLevels, ThatMeanNothingAreRefused) {
  for (const char* words : {"fidelity", "=2", "fidelity=0", "fidelity=-1", "fidelity=x", "fidelity=<2x", "fidelity=1A",
                            "fidelity=2~0", "fidelity=2~"})
    EXPECT_THROW(failure_level(words), InputError) << words;
}

TEST(FailureLevels, AreOfChecksThatAreMade) {
  for (const char* name : {"mean_error", "fidelity", "correlation@5Hz", "parameter:1", "parameter:41"})
    EXPECT_NO_THROW(require_check(name)) << name;
  for (const char* name : {"", "no_such_check", "parameter:42", "parameter:0"})
    EXPECT_THROW(require_check(name), InputError) << name;
}

TEST(Lists, NameEachThingOnce) {
  const auto unlike = [](const auto& list) {
    std::vector<std::string> names;
    for (const auto& one : list) names.push_back(one.name);
    std::sort(names.begin(), names.end());
    return !names.empty() && !names.front().empty() && std::adjacent_find(names.begin(), names.end()) == names.end();
  };
  EXPECT_TRUE(unlike(listed_faults()));
  EXPECT_TRUE(unlike(listed_effects()));
  EXPECT_TRUE(unlike(listed_rows()));
  EXPECT_TRUE(unlike(listed_maps()));
  EXPECT_TRUE(unlike(listed_signals()));
  EXPECT_EQ(listed_rows().size(), static_cast<std::size_t>(identification_model().rows));
  EXPECT_EQ(listed_signals().size(), static_cast<std::size_t>(n_signals));
}

TEST(Lists, AnEffectWithPhysicsOfItsOwnHasARangeAndOneOfTheTableNone) {
  for (const ListedEffect& effect : listed_effects())
    for (const ListedEffect::Parameter& p : effect.parameters) {
      EXPECT_EQ(p.lower.has_value(), !effect.of_table) << effect.name;
      EXPECT_TRUE(p.id == 0 || effect.of_table) << effect.name;
    }
}

}  // namespace
}  // namespace servodx
