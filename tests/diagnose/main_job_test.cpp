// Tune, baseline, diagnose on pieces of the committed logs: the whole path, short enough for every run of the tests.
// The study with whole logs and rotations is bench/confusion.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

#include "diagnose/baseline.h"
#include "diagnose/decide.h"
#include "diagnose/diagnose.h"
#include "diagnose/judge.h"
#include "faults/fault.h"
#include "faults/registry.h"
#include "servodx/diagnose.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "tune/tune.h"

namespace servodx {
namespace {

// Samples [from, to) of a log, as a log.
Log piece(Log log, std::size_t from, std::size_t to) {
  const auto cut = [&](std::vector<double>& v) {
    if (v.empty()) return;
    v.resize(to);
    v.erase(v.begin(), v.begin() + static_cast<long>(from));
  };
  cut(log.time);
  for (Channel& c : log.channels) cut(c.value);
  return log;
}

TEST(MainJob, LostWireIsFoundAndSizedAndNoFaultTakenForAnother) {
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  const RigFile rig = shipped_rig();
  // The mixed logs step by up to half of the rated current from 0.4 s on.
  constexpr std::size_t from = 400, to = 1300;
  const auto pieces = [&](const std::vector<std::string>& names) {
    std::vector<Log> out;
    for (const std::string& name : names) out.push_back(piece(shipped_log(name), from, to));
    return out;
  };
  TuneOptions o;
  o.generations = 2;
  o.population = 24;  // the least that four islands take
  const TuneResult tuned = tune_table(pieces({"healthy/h01_steps_large", "healthy/h12_mixed", "healthy/h04_multisine"}),
                                      read_table(shipped("params/borello2009.csv")), rig, o);
  std::printf("tuned after %.1f s\n", seconds());
  const DetectionBaseline baseline =
      make_baseline(pieces({"healthy/h15_no_supply_signals", "healthy/h05_prbs", "healthy/h03_sine_2hz"}), tuned.table,
                    rig, 0.01, {});
  std::printf("baseline after %.1f s: threshold %.2f, adequacy limit %.2f; %d logs\n", seconds(), baseline.threshold,
              baseline.adequacy_limit, baseline.logs);
  struct Case {
    std::string log;
    const Fault* truth;  // null: healthy
    double left;         // of the wire
  };
  const Fault* wire_lost = find_fault("feedback_wire_lost");
  const std::vector<Case> cases = {{"healthy/h06_sweep", nullptr, 1.0},
                                   {"fault/f02_clogged_filter_severe", find_fault("clogged_filter"), 1.0},
                                   {"fault/f05_wire_lost_mild", wire_lost, 0.5},
                                   {"fault/f06_wire_lost_medium", wire_lost, 0.2},
                                   {"fault/f08_sticky_spool_severe", find_fault("sticky_spool"), 1.0}};
  int faults = 0, detected = 0, named = 0;
  for (const Case& c : cases) {
    const Diagnosis d = diagnose(piece(shipped_log(c.log), from, to), tuned.table, rig, baseline, {});
    std::string ambiguous;
    for (const Fault* other : d.ambiguous_with) ambiguous += " or " + std::string(other ? other->name : "health");
    std::printf("%-34s -> %-24s score %7.2f size %.3g [%.3g, %.3g]%s  (%.1f s)\n", c.log.c_str(),
                d.fault ? d.fault->name.data() : "no fault named", d.error, d.severity.value, d.severity.lower,
                d.severity.upper, ambiguous.c_str(), seconds());
    // GA paper, "Parameter finding approach": sub-groups, each with a failure mode identifier, come to the same
    // verdict.
    DiagnoseOptions by_genes;
    by_genes.search = FaultSearch::genetic;
    by_genes.population = 24;
    const Diagnosis g = diagnose(piece(shipped_log(c.log), from, to), tuned.table, rig, baseline, by_genes);
    EXPECT_EQ(g.verdict, d.verdict) << c.log;
    EXPECT_EQ(g.fault, d.fault) << c.log;
    EXPECT_NE(g.assessment.simulations, d.assessment.simulations) << "another search";
    if (!c.truth) continue;  // one log in four may be called faulty: three baseline logs promise no more
    ++faults;
    detected += d.verdict != VerdictKind::healthy;
    named += d.fault == c.truth;
    // A second of steps may be too little to see a fault; it must not show another one.
    const bool listed = std::find(d.ambiguous_with.begin(), d.ambiguous_with.end(), c.truth) != d.ambiguous_with.end();
    EXPECT_TRUE(!d.fault || d.fault == c.truth || listed) << c.log;
    if (c.truth != wire_lost) continue;
    // The static gain doubles, or rises fivefold: far beyond what health leaves.
    EXPECT_EQ(d.verdict, VerdictKind::fault) << c.log;
    EXPECT_GT(d.error, 3 * baseline.threshold) << c.log;
    EXPECT_NEAR(d.severity.value, c.left, 0.15) << c.log;
  }
  std::printf("%d faults: %d detected, %d named\n", faults, detected, named);

  // Two pieces of one valve in one state say together what each says, and more sharply.
  const Log first = piece(shipped_log("fault/f06_wire_lost_medium"), from, 850);
  const Log second = piece(shipped_log("fault/f06_wire_lost_medium"), 850, to);
  const Diagnosis alone = judge(assess(first, tuned.table, rig, {}), baseline);
  const Diagnosis pooled = judge(assess_pool({first, second}, tuned.table, rig, {}), baseline);
  EXPECT_EQ(pooled.fault, wire_lost);
  EXPECT_EQ(pooled.assessment.logs.size(), 2u);
  EXPECT_NEAR(pooled.severity.value, 0.2, 0.15);
  EXPECT_GT(pooled.error, alone.error);
}

}  // namespace
}  // namespace servodx
