// The one list of nuisances: places in a candidate, free values of a fit and the page follow it.
#include "simulate/nuisance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "effects/registry.h"
#include "effects/viscosity_change.h"
#include "fit/candidate_of.h"
#include "fit/chart.h"
#include "fit/free_values.h"
#include "fit/log_data.h"
#include "fit/oil_of.h"
#include "fit/recorder.h"
#include "parameters/list.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "signals/signal.h"
#include "simulate/scenario.h"
#include "simulate/simulate.h"

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

// Root mean square of the difference of a signal.
double apart(const Trajectory& a, const Trajectory& b, Signal s) {
  const auto& x = a.signals[static_cast<std::size_t>(simulated_index(s))];
  const auto& y = b.signals[static_cast<std::size_t>(simulated_index(s))];
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
  return std::sqrt(sum / static_cast<double>(x.size()));
}

TEST(Nuisances, AnOilOfUnknownTemperatureThatIsThickerIsColderInAllThatShows) {
  LogData log = prepare(shipped_log("healthy/h01_steps_large"), shipped_rig());
  const ParameterVector base = candidate_of(shipped_table());
  constexpr double taken = 313.15, cold = 283.15;  // [K]
  log.scenario.oil = oil_of(log.fluid, cold);
  const Trajectory truth = simulate(log.scenario, base);
  const double thicker = log.scenario.oil.viscosity_ratio;
  log.scenario.oil = oil_of(log.fluid, taken), log.scenario.oil_known = false;
  const Trajectory as_taken = simulate(log.scenario, base);
  ParameterVector follows = base;
  int found = 0;
  for (const FreeValue& f : nuisance_values(log, 0, base, 0.05))
    if (f.name == ViscosityChange::parameters[0].name) f.apply(follows.data(), thicker), ++found;
  ASSERT_EQ(found, 1);
  const Trajectory followed = simulate(log.scenario, follows);
  for (const Signal s : {Signal::piston_position, Signal::pressure_a, Signal::pressure_b})
    EXPECT_LT(apart(followed, truth, s), 0.2 * apart(as_taken, truth, s)) << info(s).name;
  ParameterVector same = base;
  for (const FreeValue& f : nuisance_values(log, 0, base, 0.05))
    if (f.name == ViscosityChange::parameters[0].name) f.apply(same.data(), 1.0);
  EXPECT_NEAR(same[row::bulk_modulus], base[row::bulk_modulus], 1e-9 * base[row::bulk_modulus]);
  EXPECT_NEAR(same[row::port_width], base[row::port_width], 1e-9 * base[row::port_width]);
}

TEST(Nuisances, WhatATuneFoundOfTheRecorderIsLikelyOfTheNextLog) {
  const auto slope = [](const LogData& log) {
    std::vector<FreeValue> out;
    for (const FreeValue& f : nuisance_values(log, 0, candidate_of(shipped_table()), 0.05))
      if (f.at == nuisance::command_slope) out.push_back(f);
    return out;
  };
  const Log log = shipped_log("healthy/h01_steps_large");
  const auto alone = slope(prepare(log, shipped_rig()));
  const auto known = slope(prepare(log, shipped_rig(), {1, CommandSlope{0.2, 0.05}}));
  ASSERT_EQ(alone.size(), 1u);
  ASSERT_EQ(known.size(), 1u);
  EXPECT_EQ(known[0].start, 0.2);
  EXPECT_DOUBLE_EQ(known[0].prior_sd, 0.05);
  EXPECT_EQ(known[0].lower, alone[0].lower) << "another recorder is not ruled out";
  EXPECT_EQ(known[0].upper, alone[0].upper);
  EXPECT_EQ(slope(prepare(log, shipped_rig(), {1, CommandSlope{0.2, 9.0}}))[0].prior_sd, alone[0].prior_sd);
  RigFile states = shipped_rig();
  states.command_hold = CommandHold::zero;
  EXPECT_TRUE(slope(prepare(log, states, {1, CommandSlope{0.2, 0.05}})).empty()) << "the rig file says it";
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
