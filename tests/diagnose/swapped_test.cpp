// Exchanged columns are found by what they do, and columns as they should be are not.
#include "diagnose/swapped.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "servodx/check_log.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "signals/signal.h"

namespace servodx {
namespace {

Log exchanged(Log log, Signal a, Signal b) {
  std::swap(log.channels[index(a)].value, log.channels[index(b)].value);
  return log;
}

bool names(const Log& log, Signal a, Signal b) {
  const auto found = swapped_channels(log, 1000);
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

// Said once and loudly: what the chambers lie below then is no news.
TEST(Swapped, AReturnAboveTheSupplyIsImpossible) {
  Log log = shipped_log("healthy/h12_mixed");
  for (double& p : log.channels[index(Signal::return_pressure)].value) p += 300e5;
  const auto found = swapped_channels(log, 1000);
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
      EXPECT_TRUE(swapped_channels(log, 1000).empty()) << entry.path();
      ++logs;
    }
  EXPECT_GT(logs, 5);
}

}  // namespace
}  // namespace servodx
