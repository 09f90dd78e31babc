// What a whole tune promises of its search.
#include "fit/tune.h"

#include <gtest/gtest.h>

#include "recovery/twins.h"

namespace servodx {
namespace {

// A child that is worse than its parent after some logs does not run the others. Between generations 10 and 20 there
// are 488 children (waves of 64, the last of 40), and the best is shown in full once.
TEST(Tune, ALosingChildDoesNotRunTheLogsThatAreLeft) {
  std::vector<Log> logs;
  for (const char* name : {"h01_steps_large", "h04_multisine", "h05_prbs", "h06_sweep", "h12_mixed", "h13_mixed_cold"})
    logs.push_back(twins::cut(shipped_log(std::string("healthy/") + name), 400));
  Table table = shipped_table();
  for (Row& row : table.rows)
    row.estimate = std::find(twins::rows().begin(), twins::rows().begin() + 8, row.name) != twins::rows().begin() + 8;
  TuneOptions o;
  o.quiet = true;
  o.generations = 20;
  o.rounds = 1;
  o.effects.emplace();
  const TuneResult result = tune(logs, table, shipped_rig(), o);
  std::vector<long> shown;
  for (const ConvergencePoint& p : result.convergence)
    if (p.stage == "genetic search") shown.push_back(p.simulations);
  ASSERT_EQ(shown.size(), 3u);  // before the first generation, after 10 and 20
  const long all = 488 * static_cast<long>(logs.size());
  std::printf("%ld runs of %ld\n", shown[2] - shown[1], all + static_cast<long>(logs.size()));
  EXPECT_LT(shown[2] - shown[1], all);
  EXPECT_GT(shown[2] - shown[1], all / 6);  // the first logs are everybody's
}

}  // namespace
}  // namespace servodx
