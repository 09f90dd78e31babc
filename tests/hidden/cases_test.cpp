// The generator of hidden effects: what it hides is in the log, and nowhere else.
#include "hidden/cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "explain/explain.h"
#include "explain/outcome.h"
#include "servodx/rig.h"
#include "temporary_folder.h"

namespace servodx::hidden {
namespace {

Bench bench(const std::filesystem::path& folder) {
  const std::string source = SERVODX_SOURCE_DIR;
  return {folder, source + "/params/rigs/borello2009.toml", read_rig_file(source + "/data/rig.toml"), 1};
}
std::string bytes(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(Hidden, EveryEffectChangesTheLogThatAControlWouldBe) {
  const TemporaryFolder folder;
  const Bench b = bench(folder.path);
  const Case control = make_case(b, 5, "none", 0.3);
  const std::string plain = bytes(control.logs[0]);
  for (const auto* list : {&effects(), &unlisted()})
    for (const std::string& name : *list) {
      const Case c = make_case(b, 5, name, 0.3);
      EXPECT_NE(bytes(c.logs[0]), plain) << name;
      EXPECT_EQ(unseal(c.sealed).effect, name);
      EXPECT_FALSE(unseal(c.sealed).where.empty()) << name;
    }
}

TEST(Hidden, LogSaysNothingOfWhatIsInIt) {
  const TemporaryFolder folder;
  const Case c = make_case(bench(folder.path), 6, "stiction", 0.2);
  for (const std::string& log : c.logs) {
    EXPECT_EQ(log.find("stiction"), std::string::npos);
    EXPECT_EQ(bytes(log).find("stiction"), std::string::npos);
  }
}

TEST(Hidden, SameSeedSameCase) {
  const TemporaryFolder one, two;
  EXPECT_EQ(bytes(make_case(bench(one.path), 7, "", 0.2).logs[1]),
            bytes(make_case(bench(two.path), 7, "", 0.2).logs[1]));
}

TEST(Hidden, ScoreKnowsRightFromWrong) {
  ExplainResult answer;
  answer.verdict = ExplainVerdict::extended;
  answer.where = "drive";
  answer.causes.push_back({"transport_delay",
                           "drive",
                           "",
                           {{"transport_delay", "s", 2.1e-3, 1e-4, 0.0, 1.9e-3, 2.3e-3}},
                           {},
                           {},
                           0,
                           {"sensor_lag"}});
  const Truth truth{"transport_delay", {"drive"}, "transport_delay", 2e-3, ""};
  const Score right = score(truth, answer);
  EXPECT_TRUE(right.named && right.placed && right.accused && right.size_inside.value_or(false));
  const Score other = score({"stiction", {"spool"}, "", 0, ""}, answer);
  EXPECT_FALSE(other.named || other.placed);
  EXPECT_TRUE(score({"sensor_lag", {"drive"}, "", 0, ""}, answer).named) << "a declared alternative counts";
  EXPECT_TRUE(score({"none", {}, "", 0, ""}, answer).accused);
}

}  // namespace
}  // namespace servodx::hidden
