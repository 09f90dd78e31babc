// Nozzles that differ, on logs of the virtual rig: its equations are not the model's.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "parameters/table.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "servodx/log.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "temporary_folder.h"
#include "tune/tune.h"

namespace servodx {
namespace {

struct Excess {
  double value = 0, error = 0;
};

// What `tune` finds of a valve whose nozzle 1 passes as much more, nozzle 2 as much less than the mean of both.
Excess tuned(double excess) {
  rig::RigModel valve = rig::read_rig_model(shipped("params/rigs/borello2009.toml"));
  valve.nozzles_asymmetry = 2 * excess;
  TemporaryFolder folder;
  std::vector<Log> logs;
  for (const auto& [excitation, seconds, celsius] :
       {std::tuple{"mixed", 3.0, 40.0}, {"preflight_slew", 1.51, 40.0}, {"preflight_slew", 1.51, 10.0}}) {
    rig::RigRun run;
    run.excitation = excitation, run.duration = seconds, run.temperature = celsius + 273.15;
    const rig::RigLog log = run_rig(valve, run);
    const std::string file = folder / (std::to_string(logs.size()) + ".csv");
    write_log(file, log.columns);
    logs.push_back(read_log(file, shipped_rig()));
  }
  TuneOptions options;
  options.generations = 0;
  const Table table = tune_table(logs, shipped_table(), shipped_rig(), options).table;
  const int row = table.find("nozzle_1_excess");
  return {table[row].nominal, table[row].std_error.value()};
}

TEST(NozzleMismatch, IsTunedOnTheVirtualRigOnEitherSide) {
  constexpr double excess = 0.03;
  const Excess more = tuned(excess), less = tuned(-excess);
  std::printf("%+.4f +- %.4f and %+.4f +- %.4f for %+.2f and %+.2f\n", more.value, more.error, less.value, less.error,
              excess, -excess);
  // What the model has wrong of the type both have alike.
  EXPECT_NEAR(more.value - less.value, 2 * excess, 0.25 * 2 * excess);
  EXPECT_GT(more.value, 0);
  EXPECT_LT(less.value, 0);
}

}  // namespace
}  // namespace servodx
