// A labelled set: the same whoever makes it, and with every label of the contract.
#include "rig/labelled_fleet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <set>

#include "base/error.h"
#include "rig/rig_model.h"
#include "rig/rig_run.h"
#include "rig_test_support.h"

namespace servodx::rig {
namespace {

FleetOptions small(int logs) { return {.logs = logs, .seed = 3, .duration = 0.05}; }

std::map<std::string, std::vector<double>> made(const std::vector<FleetLog>& plan, int threads) {
  std::map<std::string, std::vector<double>> spools;
  std::mutex mutex;
  const std::atomic<bool> stop{false};
  run_fleet(
      flight_rig(), plan, threads, stop,
      [&](const FleetLog& item, const RigModel&, RigLog&& log) {
        const std::lock_guard lock(mutex);
        spools[item.folder + "/" + item.path] = log.columns[2].value;
      },
      [](double, long) {});
  return spools;
}

TEST(Fleet, IsTheSameForAnyNumberOfThreads) {
  const auto plan = plan_fleet(small(6));
  EXPECT_EQ(made(plan, 1), made(plan, 3));
}

TEST(Fleet, HalfIsHealthyAndEveryLabelOfTheContractComesUp) {
  const auto plan = plan_fleet({.logs = 60});
  std::set<std::string> labels, paths;
  int healthy = 0, sudden = 0;
  for (const auto& log : plan) {
    labels.insert(log.label);
    paths.insert(log.folder + "/" + log.path);
    healthy += log.label == "healthy";
    sudden += log.set == FleetSet::sudden;
    EXPECT_TRUE(log.path.starts_with(name_of(log.set))) << log.path;
    EXPECT_EQ(log.severity == Grade::none, log.label == "healthy");
    EXPECT_EQ(log.run.faults.empty(), log.label == "healthy");
  }
  EXPECT_EQ(paths.size(), 60u);
  EXPECT_EQ(healthy, 30);
  EXPECT_EQ(sudden, 6);
  for (const char* label :
       {"clogged_filter", "torque_motor_loss", "feedback_wire_backlash", "feedback_wire_lost", "sticky_spool",
        "radial_clearance_wear", "null_shift", "plugged_nozzle", "cylinder_leakage", "sensor_fault", "supply_fault"}) {
    EXPECT_TRUE(labels.contains(label)) << label;
  }
}

TEST(Fleet, ValvesOfOneFleetDiffer) {
  const auto plan = plan_fleet({.logs = 4, .valves = 2});
  EXPECT_EQ(plan[0].folder, plan[2].folder);
  EXPECT_NE(plan[0].folder, plan[1].folder);
  EXPECT_EQ(model_of(flight_rig(), plan[0]).edges_lap_pa, model_of(flight_rig(), plan[2]).edges_lap_pa);
  EXPECT_NE(model_of(flight_rig(), plan[0]).edges_lap_pa, model_of(flight_rig(), plan[1]).edges_lap_pa);
}

TEST(Fleet, StoppedWritesNothingHalf) {
  const auto plan = plan_fleet(small(4));
  const std::atomic<bool> stop{true};
  int writes = 0;
  const auto written = run_fleet(
      flight_rig(), plan, 1, stop, [&](const FleetLog&, const RigModel&, RigLog&&) { ++writes; }, [](double, long) {});
  EXPECT_EQ(writes, 0);
  EXPECT_EQ(std::count(written.begin(), written.end(), true), 0);
  const std::string table = truth_table(plan, written, "valve_01");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1);  // its header
}

TEST(Fleet, TheTruthNamesSetAndGradeOfEachLog) {
  const auto plan = plan_fleet({.logs = 30});
  const std::string table = truth_table(plan, std::vector<bool>(plan.size(), true), "valve_01");
  for (const FleetLog& log : plan) {
    const std::string row = log.path + "," + name_of(log.set) + "," + log.label + "," + name_of(log.severity) + ",";
    EXPECT_NE(table.find("\n" + row), std::string::npos) << row;
  }
  EXPECT_NE(table.find(",sudden,"), std::string::npos);
  EXPECT_NE(table.find(",healthy,none,0,"), std::string::npos);
  EXPECT_TRUE(table.find(",mild,") != std::string::npos || table.find(",severe,") != std::string::npos);
}

TEST(Fleet, AFailedWriteIsTold) {
  const std::atomic<bool> stop{false};
  EXPECT_THROW(run_fleet(
                   flight_rig(), plan_fleet(small(2)), 2, stop,
                   [](const FleetLog&, const RigModel&, RigLog&&) { throw std::runtime_error("disk full"); },
                   [](double, long) {}),
               std::runtime_error);
}

TEST(Fleet, RefusesCountsThatMakeNoSense) {
  EXPECT_THROW(plan_fleet({.logs = 0}), InputError);
  EXPECT_THROW(plan_fleet({.logs = 2, .valves = 3}), InputError);
}

}  // namespace
}  // namespace servodx::rig
