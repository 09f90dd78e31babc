// A fixed subset of the study of hidden effects (bench/hidden.cpp) with its own counts: valve 1 of the virtual rig, one
// log of 2 s a case, its tuned table and its healthy logs' scores as committed beside this file. Both are made by
//   servodx_hidden --valves 1 --cases 0 --controls 0 --out DIR
//   cp DIR/tuned_v1.csv tests/hidden/valve_1.csv; cp DIR/reference_v1.json tests/hidden/valve_1.json
#include <gtest/gtest.h>

#include "explain/explain.h"
#include "explain/healthy.h"
#include "explain/outcome.h"
#include "hidden/cases.h"
#include "parameters/table.h"
#include "report/explain/explain_words.h"
#include "servodx/explain.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "store/healthy_file.h"
#include "temporary_folder.h"

namespace servodx::hidden {
namespace {

constexpr double seconds = 2.0, level = 0.05;  // nineteen healthy logs promise no less

class HiddenStudy : public testing::Test {
 protected:
  HiddenStudy()
      : bench_{folder_.path, source + "/params/rigs/borello2009.toml", read_rig_file(source + "/data/rig.toml"), 1},
        tuned_(read_table(source + "/tests/hidden/valve_1.csv")),
        healthy_(store::read_healthy(source + "/tests/hidden/valve_1.json")) {}

  Score judge(std::uint64_t seed, const std::string& effect, const std::string& excitation,
              const std::vector<std::string>& without = {}) {
    const Case c = make_case(bench_, seed, effect, seconds, {excitation});
    ExplainOptions options;
    options.level = level, options.without = without;
    const ExplainResult answer =
        explain_logs({read_log(c.logs.front(), bench_.rig)}, tuned_, bench_.rig, &healthy_, options);
    const Score s = score(unseal(c.sealed), answer);  // opened after the answer
    std::printf("  %s %s -> %s %s %s %s\n", s.truth.effect.c_str(), s.truth.size.c_str(), report::word_of(s.verdict),
                s.first.c_str(), s.where.c_str(), answer.depends_on.c_str());
    return s;
  }

  const std::string source = SERVODX_SOURCE_DIR;
  TemporaryFolder folder_;
  Bench bench_;
  Table tuned_;
  HealthyReference healthy_;
};

TEST_F(HiddenStudy, MostOfAFixedSubsetAreNamedAndPlaced) {
  std::vector<Score> scores;
  for (const auto& [effect, excitation] :
       std::vector<std::pair<std::string, std::string>>{{"transport_delay", "mixed"},
                                                        {"stiction", "mixed"},
                                                        {"cross_piston_leakage", "flight"},
                                                        {"sensor_gain_error", "flight"},
                                                        {"viscosity_change", "flight"},
                                                        {"stribeck_friction", "mixed"}})
    scores.push_back(judge(11, effect, excitation));
  std::printf("%s", tally(scores).c_str());
  int named = 0, placed = 0;
  for (const Score& s : scores) named += s.named, placed += s.placed;
  EXPECT_GE(named, 5);
  EXPECT_GE(placed, 5);
}

TEST_F(HiddenStudy, ControlsAreLeftAlone) {
  int accused = 0;
  for (std::uint64_t seed = 21; seed < 24; ++seed)
    accused += judge(seed, "none", seed % 2 ? "mixed" : "flight").accused;
  EXPECT_LE(accused, 1);  // at one in twenty each
}

// Nothing in the list is it: unexplained, at its place, by what it depends on.
TEST_F(HiddenStudy, WhatIsNotInTheListIsPlacedAndItsVariableFound) {
  for (const auto& [effect, excitation] : std::vector<std::pair<std::string, std::string>>{
           {"unlisted:spring", "mixed"}, {"unlisted:saturation", "flight"}})
    EXPECT_TRUE(judge(11, effect, excitation).variable.value_or(false)) << effect;
}

// Its file is left out of the list: no other name may take its place. Where one does is in docs/not_done.md.
TEST_F(HiddenStudy, EffectWhoseFileIsRemovedIsUnexplained) {
  for (const char* effect : {"cross_piston_leakage", "mains_pickup", "sensor_lag"})
    EXPECT_EQ(judge(11, effect, "flight", {effect}).verdict, ExplainVerdict::unexplained) << effect;
}

}  // namespace
}  // namespace servodx::hidden
