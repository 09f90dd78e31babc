// A real servovalve on a test stand, against a table that was fitted to other sweeps of it. The data are not part of
// this project.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/support.h"
#include "parameters/table.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

struct Sweep {
  LogData data;
  std::vector<double> simulated;
  const std::vector<double>& measured() const { return data.channels.front().measured; }
  double rms() const {
    double sum = 0;
    for (std::size_t k = 0; k < simulated.size(); ++k) sum += std::pow(simulated[k] - measured()[k], 2);
    return std::sqrt(sum / static_cast<double>(simulated.size()));
  }
  // What remains of the best curve that gives one value a command, in bins of a tenth of a milliamp.
  double best_single_valued() const {
    std::map<long, std::array<double, 3>> bins;
    for (std::size_t k = 0; k < simulated.size(); ++k) {
      auto& [n, sum, square] = bins[std::lround(data.scenario.command[k] / 1e-4)];
      n += 1, sum += measured()[k], square += measured()[k] * measured()[k];
    }
    double left = 0;
    for (const auto& [bin, b] : bins) left += b[2] - b[1] * b[1] / b[0];
    return std::sqrt(left / static_cast<double>(simulated.size()));
  }
};

class BenchValve : public ::testing::Test {
 protected:
  const std::filesystem::path folder = std::filesystem::path(SERVODX_SHARED_DIR) / "data/real/servovalve_static";
  void SetUp() override {
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  }
  Sweep sweep(const std::string& name) const {
    const RigFile rig = read_rig_file(shipped("data/bench_valve/rig.toml"));
    Sweep s{prepare(read_log((folder / (name + ".csv")).string(), rig), rig), {}};
    s.data.scenario.command_slope = 0.5;  // not known
    SimulateOptions o;
    o.wanted.fill(false);
    o.wanted[static_cast<std::size_t>(s.data.channels.front().simulated)] = true;
    const Trajectory t = simulate(s.data.scenario, candidate_of(read_table(shipped("data/bench_valve/table.csv"))), o);
    EXPECT_TRUE(t.ok);
    s.simulated = t.signals[static_cast<std::size_t>(s.data.channels.front().simulated)];
    return s;
  }
};

TEST_F(BenchValve, TheTableBeatsEverySingleValuedCurveOnTheSweepsThatItWasFittedTo) {
  for (const char* name : {"leakage_period_500", "leakage_period_20", "pressure_gain", "flow_gain"}) {
    const Sweep s = sweep(name);
    EXPECT_LT(s.rms(), s.best_single_valued()) << name;
  }
}

TEST_F(BenchValve, TheSweepHeldOutIsPredictedWithinHalfOfWhatASingleValuedCurveLeaves) {
  const Sweep s = sweep("leakage_period_100");
  EXPECT_LT(s.rms(), 0.5 * s.best_single_valued());
}

}  // namespace
}  // namespace servodx
