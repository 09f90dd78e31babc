// A fixed subset of the study of hidden effects (bench/hidden.cpp), with its own counts: one valve of the virtual rig,
// its tuned table (valve_1.csv, by `servodx_hidden`), a baseline of six logs, a log a case.
#include <gtest/gtest.h>

#include "explain/healthy.h"
#include "hidden/cases.h"
#include "parameters/table.h"
#include "temporary_folder.h"

namespace servodx::hidden {
namespace {

constexpr double seconds = 2.5, level = 1.0 / 7;  // six healthy logs promise no less

class HiddenStudy : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const std::string source = SERVODX_SOURCE_DIR;
    folder = new TemporaryFolder;
    bench =
        new Bench{folder->path, source + "/params/rigs/borello2009.toml", read_rig_file(source + "/data/rig.toml"), 1};
    tuned = new Table(read_table(source + "/tests/hidden/valve_1.csv"));
    reference = new HealthyReference;
    for (const std::string& path : healthy_logs(*bench, 1001, 6, "base", seconds))
      reference->logs.push_back(score_healthy(read_log(path, bench->rig), *tuned, bench->rig, 0, nullptr, nullptr));
  }
  static void TearDownTestSuite() {
    delete reference;
    delete tuned;
    delete bench;
    delete folder;
  }
  static Score judge(std::uint64_t seed, const std::string& effect, const std::string& excitation,
                     const std::vector<std::string>& without = {}) {
    const Case c = make_case(*bench, seed, effect, seconds, {excitation});
    ExplainOptions options;
    options.quiet = true, options.level = level, options.without = without;
    const ExplainResult answer =
        explain_logs({read_log(c.logs.front(), bench->rig)}, *tuned, bench->rig, reference, options);
    const Score s = score(unseal(c.sealed), answer);  // opened after the answer
    std::printf("  %s %s -> %s %s %s\n", s.truth.effect.c_str(), s.truth.size.c_str(), s.verdict.c_str(),
                s.first.c_str(), s.where.c_str());
    return s;
  }
  static TemporaryFolder* folder;
  static Bench* bench;
  static Table* tuned;
  static HealthyReference* reference;
};
TemporaryFolder* HiddenStudy::folder = nullptr;
Bench* HiddenStudy::bench = nullptr;
Table* HiddenStudy::tuned = nullptr;
HealthyReference* HiddenStudy::reference = nullptr;

TEST_F(HiddenStudy, MostOfAFixedSubsetAreNamedAndPlaced) {
  std::vector<Score> scores;
  for (const auto& [effect, excitation] :
       std::vector<std::pair<std::string, std::string>>{{"transport_delay", "mixed"},
                                                        {"cross_piston_leakage", "flight"},
                                                        {"sensor_gain_error", "flight"},
                                                        {"sensor_lag", "mixed"},
                                                        {"supply_droop", "mixed"}})
    scores.push_back(judge(11, effect, excitation));
  std::printf("%s", tally(scores).c_str());
  int named = 0, placed = 0;
  for (const Score& s : scores) named += s.named, placed += s.placed;
  EXPECT_GE(named, 4);
  EXPECT_GE(placed, 4);
}

TEST_F(HiddenStudy, ControlsAreLeftAlone) {
  int accused = 0;
  for (std::uint64_t seed = 21; seed < 24; ++seed)
    accused += judge(seed, "none", seed % 2 ? "mixed" : "flight").accused;
  EXPECT_EQ(accused, 0);
}

}  // namespace
}  // namespace servodx::hidden
