// Laws that a foreign rig keeps, whatever seed it was drawn from.
#include "servodx/rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "foreign/condition.h"
#include "foreign/design.h"
#include "foreign/excite.h"
#include "foreign/faults.h"
#include "foreign/machine.h"
#include "foreign/oil.h"
#include "foreign/run.h"
#include "foreign/set.h"
#include "foreign/sheet.h"
#include "foreign/write.h"
#include "servodx/log.h"
#include "temporary_folder.h"

namespace servodx::foreign {
namespace {

constexpr std::uint64_t seeds[] = {2, 3, 5, 8, 19};

// Runs the machine alone at a constant current from rest; the last state and its flows.
struct Steady {
  State state, rates;
  Flows flows;
};
Steady steady(const Design& d, const Condition& c, double level, double seconds) {
  const Machine machine(d, c);
  Steady s{machine.rest(), {}, {}};
  // Begins at the far end, so that the travel is there.
  s.state[x_piston] = -std::copysign(0.4 * d.actuator.stroke, level);
  const Drive in{level * d.rated_current};
  for (long i = 0, n = std::lround(seconds / d.step); i < n; ++i) machine.step(s.state, in, d.step);
  machine.rates(s.state, in, s.rates, s.flows);
  return s;
}

TEST(ForeignRig, FlowBalancesInSteadyExtension) {
  for (const std::uint64_t seed : seeds) {
    const Design d = draw_design(seed);
    const double level = 0.5;
    const Steady s = steady(d, Condition{}, level, 0.5 * 0.6 * d.actuator.stroke / (level * d.speed));
    const double speed = s.state[v_piston], swept = d.actuator.area_a * speed, rest = 0.02 * d.no_load_flow;
    ASSERT_GT(speed, 0.0) << seed;
    EXPECT_NEAR(s.state[q_line_a], swept + s.flows.across, rest) << seed;
    EXPECT_NEAR(-s.state[q_line_b], d.actuator.area_b * speed + s.flows.across, rest) << seed;
    const auto& e = s.flows.edge;
    EXPECT_NEAR(e[edge_pa] - e[edge_at], s.state[q_line_a], rest) << seed;
    EXPECT_NEAR(e[edge_pa] + e[edge_pb] + s.flows.screen, s.state[q_supply], rest) << seed;
    EXPECT_NEAR(s.flows.screen, s.flows.nozzle_1 + s.flows.nozzle_2, 0.05 * d.first.pilot_flow) << seed;
  }
}

// Rated current across the two open edges gives the rated flow, scaled by the root of the drop that is there.
TEST(ForeignRig, RatedCurrentGivesTheRatedFlow) {
  for (const std::uint64_t seed : seeds) {
    const Design d = draw_design(seed);
    const Steady s = steady(d, Condition{}, 1.0, 0.3 * d.actuator.stroke / d.speed + 0.05);
    const auto flow_at = [&](double q, double dp) { return q * std::sqrt(35e5 / dp); };
    const double a = flow_at(s.flows.edge[edge_pa], s.state[p_supply] - s.state[p_valve_a]);
    // What flow forces at another drop take of the stroke, and what the lines' drop adds.
    EXPECT_NEAR(a / d.rated_flow, 1.0, 0.10) << seed;
  }
}

TEST(ForeignRig, AtRestPressuresLieBetweenReturnAndSupplyAndThePistonHardlyDrifts) {
  for (const std::uint64_t seed : seeds) {
    const Design d = draw_design(seed);
    Condition c;
    c.null = 0.005;
    const Steady s = steady(d, c, 1e-9, 0.3);
    for (const Var p : {p_valve_a, p_valve_b, p_chamber_a, p_chamber_b, p_pilot_1, p_pilot_2, p_screen}) {
      EXPECT_GT(s.state[p], s.state[p_return]) << seed << " " << p;
      EXPECT_LT(s.state[p], s.state[p_supply]) << seed << " " << p;
    }
    // Laps are up to a few hundredths of the stroke; null and laps together give no more of the full speed.
    EXPECT_LT(std::abs(s.state[v_piston]), 0.06 * d.speed) << seed;
  }
}

TEST(ForeignRig, HalvingTheStepChangesALogByLessThanItsNoise) {
  for (const std::uint64_t seed : seeds) {
    const Design d = draw_design(seed);
    Job job{make_excitation(d, Trial::steps_large, Random(seed)), Condition{}};
    job.excitation.duration = 0.15;
    job.settling = 0.05;
    job.quiet = true;
    const Recording coarse = run(d, job);
    job.finer = 2.0;
    const Recording fine = run(d, job);
    ASSERT_EQ(coarse.time.size(), fine.time.size());
    for (const int c : {ch_spool, ch_piston, ch_pressure_a, ch_pressure_b}) {
      double sum = 0.0;
      for (std::size_t i = 0; i < fine.time.size(); ++i) sum += std::pow(coarse.channel[c][i] - fine.channel[c][i], 2);
      EXPECT_LT(std::sqrt(sum / static_cast<double>(fine.time.size())), d.sensors[c].noise) << seed << " channel " << c;
    }
  }
}

TEST(ForeignRig, EverySeedOfADozenStaysFiniteAndBetweenItsStops) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Design d = draw_design(seed);
    Job job{make_excitation(d, Trial::prbs, Random(seed)), Condition{}};
    job.excitation.duration = 0.04;
    job.settling = 0.03;
    job.quiet = true;
    const Recording log = run(d, job);
    for (const double x : log.channel[ch_spool]) EXPECT_LT(std::abs(x), 1.05 * d.spool.stop) << seed;
    for (const double p : log.channel[ch_pressure_a]) EXPECT_LT(p, 1.6 * d.supply.pressure) << seed;
  }
}

TEST(ForeignRig, SameSeedSameBytesAndAnotherSeedAnotherRig) {
  const auto text = [](std::uint64_t seed) {
    const Design d = draw_design(seed);
    Job job{make_excitation(d, Trial::prbs, Random(seed)), Condition{}};
    job.excitation.duration = 0.05;
    job.settling = 0.01;
    return csv_of(d, run(d, job));
  };
  EXPECT_EQ(text(4), text(4));
  EXPECT_NE(text(4), text(5));
}

TEST(ForeignRig, EveryFaultAndEffectChangesTheMotion) {
  const Design d = draw_design(11);  // one with a long step
  const auto log = [&](const Condition& c) {
    Job job{make_excitation(d, Trial::mixed, Random(2)), c};
    job.excitation.duration = 0.12;
    job.settling = 0.05;
    job.quiet = true;
    return run(d, job);
  };
  const Recording healthy = log(Condition{});
  const auto changed = [&](const Condition& c) {
    const Recording other = log(c);
    for (const int k : {ch_spool, ch_piston, ch_pressure_a})
      for (std::size_t i = 0; i < other.time.size(); ++i)
        if (std::abs(other.channel[k][i] - healthy.channel[k][i]) > 0.5 * d.sensors[k].noise) return true;
    return false;
  };
  for (const Fault& f : faults()) {
    Condition c;
    f.apply(c, d, f.severe);
    EXPECT_TRUE(changed(c)) << f.name;
  }
  for (const Effect& e : effects()) {
    Condition c;
    Random r(3);
    e.apply(c, d, 1.0, r);
    EXPECT_TRUE(changed(c) || c.pickup > 0.0) << e.name;
  }
}

TEST(ForeignRig, OilThinsWithHeatThickensWithPressureAndAirSoftensIt) {
  const OilKind kind = draw_design(1).oil;
  EXPECT_LT(kinematic_viscosity(kind, 60.0), kinematic_viscosity(kind, 20.0));
  const Oil oil(kind, 40.0, 0.005, 1.0), foam(kind, 40.0, 0.05, 1.0);
  EXPECT_GT(oil.viscosity(200e5), oil.viscosity(0.0));
  EXPECT_LT(foam.stiffness(20e5), oil.stiffness(20e5));
  EXPECT_GT(oil.stiffness(200e5), oil.stiffness(20e5));
}

// What a user's program reads: the rig file's keys, the log's columns, and nothing implausible in a usual test.
TEST(ForeignRig, LogsAndRigFilesAreReadWithoutRemark) {
  const TemporaryFolder folder;
  for (const std::uint64_t seed : seeds) {
    const Design d = draw_design(seed);
    write_text(folder.path / "rig.toml", rig_toml(d, draw_sheet(d)));
    const RigFile rig = read_rig_file(folder / "rig.toml");
    EXPECT_NEAR(*rig.fact("supply.pressure"), d.supply.pressure, 0.02 * d.supply.pressure);
    Job job{make_excitation(d, Trial::multisine, Random(seed)), Condition{}};
    job.excitation.duration = 0.3;
    job.settling = 0.05;
    write_text(folder.path / "log.csv", csv_of(d, run(d, job)));
    const Log log = read_log(folder / "log.csv", rig);
    EXPECT_TRUE(log.notes.empty()) << seed << ": " << log.notes.front().text;
    EXPECT_EQ(log.has(Signal::spool_position), d.recorded[ch_spool]);
  }
}

}  // namespace
}  // namespace servodx::foreign
