// A fixed part of the study of hidden effects (bench/hidden.cpp), on one valve that was tuned beforehand: found where
// there is something, silent where there is nothing, and without a name where the name is not in the list.
//
// kept/: the tuned table and what healthy logs of that valve show, as `servodx_hidden --valves 1` writes them; made
// anew with it when the model or the virtual rig changes.
#include <gtest/gtest.h>

#include "hidden/cases.h"
#include "report/explain_report.h"
#include "temporary_folder.h"

namespace servodx::hidden {
namespace {

constexpr double seconds = 3.0, level = 0.1;

struct KeptValve {
  const std::string source = SERVODX_SOURCE_DIR;
  TemporaryFolder folder;
  Bench bench{folder.path, source + "/params/rigs/borello2009.toml", read_rig_file(source + "/data/rig.toml"), 1};
  Table tuned = read_table(source + "/tests/hidden/kept/tuned_v1.csv");
  HealthyReference healthy = report::read_healthy(source + "/tests/hidden/kept/reference_v1.json");

  Score judge(std::uint64_t seed, const std::string& effect, const std::vector<std::string>& without = {}) const {
    const Case c = make_case(bench, seed, effect, seconds, {"flight"});
    std::vector<Log> logs;
    for (const std::string& path : c.logs) logs.push_back(read_log(path, bench.rig));
    const ExplainResult answer =
        explain_logs(logs, tuned, bench.rig, &healthy, {.quiet = true, .level = level, .without = without});
    const Score s = score(unseal(c.sealed), answer);
    std::printf("%s (%s): %s %s at %s%s\n", s.truth.effect.c_str(), s.truth.size.c_str(), s.verdict.c_str(),
                s.first.c_str(), s.where.c_str(), s.named ? "" : (", " + s.note).c_str());
    return s;
  }
};

TEST(HiddenSubset, EffectsAreNamedAndPlacedAndControlsLeftAlone) {
  const KeptValve valve;
  int named = 0, placed = 0, accused = 0;
  const std::vector<std::string> hiding = {"cross_piston_leakage", "mount_compliance", "sensor_gain_error",
                                           "transport_delay"};
  constexpr int controls = 3;
  for (const std::string& effect : hiding) {
    const Score s = valve.judge(700, effect);
    named += s.named, placed += s.placed;
  }
  for (int k = 0; k < controls; ++k) accused += valve.judge(710 + static_cast<std::uint64_t>(k), "none").accused;
  std::printf("named %d of %zu, placed %d; controls accused %d of %d\n", named, hiding.size(), placed, accused,
              controls);
  EXPECT_GE(named, 3);
  EXPECT_GE(placed, 3);
  EXPECT_LE(accused, 1);
}

}  // namespace
}  // namespace servodx::hidden
