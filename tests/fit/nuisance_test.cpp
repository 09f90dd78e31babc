// The one list of nuisances: places in a candidate, free values of a fit and the page follow it.
#include "simulate/nuisance.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "effects/registry.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "servodx/log.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

TEST(Nuisances, StandBehindTheRowsAndTheEffectsInTheOrderOfTheirList) {
  EXPECT_EQ(nuisance::command_slope, n_values);
  EXPECT_EQ(nuisance::piston_velocity_start, n_candidate - 1);
  EXPECT_EQ(nuisance_info(nuisance::spool_offset).name, "spool_offset");
  std::set<std::string_view> names;
  for (const NuisanceInfo& n : nuisance_list) {
    EXPECT_TRUE(names.insert(n.name).second) << n.name;
    EXPECT_LE(n.lower, n.prior_mean) << n.name;
    EXPECT_LE(n.prior_mean, n.upper) << n.name;
    EXPECT_GT(n.prior_sd, 0) << n.name;
  }
}

TEST(Nuisances, AllOfThemAreFreeInALogThatShowsAll) {
  LogData log;
  log.scenario.time = {0, 1e-3, 2e-3, 3e-3};
  for (const Signal s : {Signal::spool_position, Signal::piston_position, Signal::pressure_a, Signal::pressure_b,
                         Signal::pilot_pressure_1, Signal::pilot_pressure_2}) {
    FitChannel c;
    c.signal = s;
    c.noise = 1.0;
    log.channels.push_back(c);
  }
  std::vector<FreeValue> free = nuisance_values(log, 0, candidate_of(shipped_table()), 0.05);
  for (FreeValue& f : start_values(log, 0)) free.push_back(f);
  std::set<int> places;
  for (const FreeValue& f : free) {
    if (f.at < n_values) continue;
    const NuisanceInfo& n = nuisance_info(f.at);
    EXPECT_EQ(f.name, n.name);
    EXPECT_EQ(f.prior_sd, n.prior_sd) << f.name;
    const bool follows_from_the_noise = n.upper == n.lower;
    EXPECT_TRUE(follows_from_the_noise || (f.lower == n.lower && f.upper == n.upper)) << f.name;
    places.insert(f.at);
  }
  EXPECT_EQ(static_cast<int>(places.size()), n_nuisances);
}

TEST(Nuisances, StandInTheirTableOfThePage) {
  std::ifstream file(std::string(SERVODX_SOURCE_DIR) + "/docs/model.md");
  std::stringstream text;
  text << file.rdbuf();
  const std::string page = text.str();
  const auto begin = page.find("\n## Nuisances");
  ASSERT_NE(begin, std::string::npos);
  const std::string part = page.substr(begin, page.find("\n## ", begin + 1) - begin);
  for (const NuisanceInfo& n : nuisance_list)
    EXPECT_NE(part.find("`" + std::string(n.name) + "`"), std::string::npos) << n.name;
}

}  // namespace
}  // namespace servodx
