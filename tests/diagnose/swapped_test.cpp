// Exchanged columns are found by what they do, and columns as they should be are not.
#include "diagnose/swapped.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/load_sign.h"
#include "servodx/check_log.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "signals/signal.h"

namespace servodx {
namespace {

Log exchanged(Log log, Signal a, Signal b) {
  std::swap(log.channels[index(a)].value, log.channels[index(b)].value);
  return log;
}

bool names(const Log& log, Signal a, Signal b) {
  const auto found = swapped_channels(log, shipped_rig(), 1000);
  return std::any_of(found.begin(), found.end(), [&](const Finding& f) {
    return f.kind == FindingKind::swapped && std::count(f.signals.begin(), f.signals.end(), a) > 0 &&
           std::count(f.signals.begin(), f.signals.end(), b) > 0;
  });
}

TEST(Swapped, SupplyReturnAndChambersExchangedAreFound) {
  const Log log = shipped_log("healthy/h12_mixed");
  ASSERT_TRUE(log.has(Signal::supply_pressure) && log.has(Signal::return_pressure));
  EXPECT_TRUE(
      names(exchanged(log, Signal::supply_pressure, Signal::pressure_b), Signal::supply_pressure, Signal::pressure_b));
  EXPECT_TRUE(
      names(exchanged(log, Signal::return_pressure, Signal::pressure_a), Signal::return_pressure, Signal::pressure_a));
  EXPECT_TRUE(names(exchanged(log, Signal::supply_pressure, Signal::return_pressure), Signal::supply_pressure,
                    Signal::return_pressure));
  EXPECT_TRUE(names(exchanged(log, Signal::pressure_a, Signal::pressure_b), Signal::pressure_a, Signal::pressure_b));
}

// Slow moves of a cylinder of unlike areas against a load: what compresses the oil is nothing, the flow is all.
Log slow_moves_under_load() {
  constexpr double supply = 200e5, back = 5e5, area_a = 20e-4, area_b = 10e-4, gain = 2e-4;
  constexpr double ratio = (area_a / area_b) * (area_a / area_b);
  Log log = shipped_log("healthy/h12_mixed");
  const auto channel = [&](Signal s) -> std::vector<double>& { return log.channels[index(s)].value; };
  double piston = 0;
  for (std::size_t k = 0; k < log.samples(); ++k) {
    const double t = 1e-3 * static_cast<double>(k), x = 3e-4 * std::sin(6.0 * t), load = 8e3 + 5e3 * std::sin(2.3 * t);
    // Both chambers' flows move one piston, and the pressures carry the load.
    const double b = x > 0 ? (area_a * (supply + ratio * back) - load) / (area_a * ratio + area_b)
                           : (area_a * (back + ratio * supply) - load) / (area_a * ratio + area_b);
    const double a = x > 0 ? supply - ratio * (b - back) : back + ratio * (supply - b);
    piston += 1e-3 * gain * x * std::sqrt(x > 0 ? supply - a : a - back) / area_a;
    log.time[k] = t;
    channel(Signal::spool_position)[k] = x, channel(Signal::piston_position)[k] = piston;
    channel(Signal::pressure_a)[k] = a, channel(Signal::pressure_b)[k] = b;
    channel(Signal::supply_pressure)[k] = supply, channel(Signal::return_pressure)[k] = back;
  }
  return log;
}

TEST(Swapped, ChambersAreToldByTheFlowThatMovesThePiston) {
  const Log log = slow_moves_under_load();
  EXPECT_TRUE(swapped_channels(log, shipped_rig(), 1000).empty());
  EXPECT_TRUE(names(exchanged(log, Signal::pressure_a, Signal::pressure_b), Signal::pressure_a, Signal::pressure_b));
}

TEST(Swapped, ChambersAtLikePressuresTellNothing) {
  Log log = slow_moves_under_load();
  log.channels[index(Signal::pressure_b)].value = log[Signal::pressure_a];
  for (double& p : log.channels[index(Signal::pressure_b)].value) p += 1e4;
  EXPECT_TRUE(swapped_channels(log, shipped_rig(), 1000).empty());
}

// Either chamber beside the supply: the one that stands in its column is named, and no other.
TEST(Swapped, OfTwoChambersAboveTheSupplyOneIsNamed) {
  const Log log = exchanged(slow_moves_under_load(), Signal::supply_pressure, Signal::pressure_b);
  const auto found = swapped_channels(log, shipped_rig(), 1000);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found.front().signals, (std::vector{Signal::supply_pressure, Signal::pressure_b}));
}

// Said once and loudly: what the chambers lie below then is no second finding.
TEST(Swapped, AReturnAboveTheSupplyIsImpossible) {
  Log log = shipped_log("healthy/h12_mixed");
  for (double& p : log.channels[index(Signal::return_pressure)].value) p += 300e5;
  const auto found = swapped_channels(log, shipped_rig(), 1000);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found.front().impossible);
  EXPECT_NE(found.front().text.find("'return_pressure' is above 'supply_pressure' in 100 % of the samples"),
            std::string::npos)
      << found.front().text;
}

TEST(Swapped, LogsOfHealthyAndFaultyValvesAreAsTheyShouldBe) {
  namespace fs = std::filesystem;
  int logs = 0;
  for (const char* folder : {"data/healthy", "data/fault"})
    for (const auto& entry : fs::recursive_directory_iterator(shipped(folder))) {
      if (entry.path().extension() != ".csv") continue;
      const Log log = read_log(entry.path(), shipped_rig());
      EXPECT_TRUE(swapped_channels(log, shipped_rig(), 1000).empty()) << entry.path();
      ++logs;
    }
  EXPECT_GT(logs, 5);
}

// The same moves with the load recorded, its sign as it should be (1) or turned (-1).
Log with_load(double sign) {
  Log log = slow_moves_under_load();
  std::vector<double>& load = log.channels[index(Signal::load_force)].value;
  load.resize(log.samples());
  for (std::size_t k = 0; k < load.size(); ++k)
    load[k] = sign * (20e-4 * log[Signal::pressure_a][k] - 10e-4 * log[Signal::pressure_b][k]);
  return log;
}
RigFile unlike_areas() {
  RigFile rig = shipped_rig();
  rig.facts["actuator.area_a"] = 20e-4, rig.facts["actuator.area_b"] = 10e-4;
  return rig;
}

TEST(LoadSign, ALoadAgainstThePressuresIsFoundAndOneWithThemIsNot) {
  EXPECT_FALSE(load_against_pressures(with_load(1), unlike_areas(), 1000));
  const auto found = load_against_pressures(with_load(-1), unlike_areas(), 1000);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->kind, FindingKind::sign);
  EXPECT_EQ(found->signals, std::vector{Signal::load_force});
  EXPECT_NE(found->text.find("gain = \"-1\""), std::string::npos) << found->text;
}

TEST(LoadSign, ExchangedChambersAreNotTakenForATurnedLoad) {
  RigFile rig = unlike_areas();
  std::swap(rig.facts["actuator.area_a"], rig.facts["actuator.area_b"]);  // so that the force itself is turned
  EXPECT_FALSE(load_against_pressures(exchanged(with_load(1), Signal::pressure_a, Signal::pressure_b), rig, 1000));
}

TEST(Swapped, WhereTheSpoolIsNotRecordedTheCurrentStandsForIt) {
  Log log = slow_moves_under_load();
  log.channels[index(Signal::command)].value = log[Signal::spool_position];
  log.channels[index(Signal::coil_current)].value.clear();
  log.channels[index(Signal::spool_position)].value.clear();
  ASSERT_FALSE(log.has(Signal::spool_position));
  EXPECT_FALSE(names(log, Signal::pressure_a, Signal::pressure_b));
  EXPECT_TRUE(names(exchanged(log, Signal::pressure_a, Signal::pressure_b), Signal::pressure_a, Signal::pressure_b));
}

}  // namespace
}  // namespace servodx
