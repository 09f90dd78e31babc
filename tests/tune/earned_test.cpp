// What is freed is earned: an effect stays where the logs have it.
#include "tune/earned.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mount_compliance.h"
#include "effects/registry.h"
#include "parameters/table.h"
#include "recovery/twins.h"
#include "servodx/rig.h"
#include "servodx/table.h"
#include "servodx/tune.h"
#include "shipped_data.h"
#include "tune/tune.h"

namespace servodx {
namespace {

TuneResult tuned(const std::map<int, double>& present, std::uint64_t seed, const TuneOptions& asked = {}) {
  const twins::Twin twin = twins::make(8, seed, {"healthy/h12_mixed", "healthy/h01_steps_large"}, 1500, present);
  TuneOptions o = asked;
  o.generations = 0;
  o.rounds = 1;
  RigFile rig = shipped_rig();
  const double rated = *rig.fact("valve.rated_current");
  rig.facts.clear();  // the table has them, and only the twin's rows may move
  rig.facts["valve.rated_current"] = rated;
  return tune_table(twin.logs, twin.table, rig, o);
}

std::map<std::string, bool> kept(const TuneResult& r) {
  std::map<std::string, bool> out;
  for (const EarnedEffect& e : r.effects) out[e.effect] = e.kept;
  return out;
}

TEST(EarnedEffects, WhatTheLogsHaveStaysAndMostOfWhatTheyLackGoesOff) {
  const std::map<int, double> present = {{effect_row<MagneticHysteresis>(0), 0.02},
                                         {effect_row<MountCompliance>(0), 3e-8}};
  int lacking = 0, off = 0;
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    const TuneResult r = tuned(present, seed);
    std::map<std::string, bool> effects = kept(r);
    EXPECT_TRUE(effects[MagneticHysteresis::name]) << seed;
    EXPECT_TRUE(effects[MountCompliance::name]) << seed;
    for (const EarnedEffect& e : r.effects) {
      std::printf("seed %d: %-20s %8.2f %s\n", static_cast<int>(seed), e.effect.c_str(), e.gain,
                  e.kept ? "free" : "off");
      if (e.effect == MagneticHysteresis::name || e.effect == MountCompliance::name) continue;
      ++lacking, off += !e.kept;
    }
  }
  std::printf("%d of %d that the logs lack are off\n", off, lacking);
  EXPECT_GE(lacking, 9);
  EXPECT_GE(10 * off, 9 * lacking);
}

TEST(EarnedEffects, RowsOfWhatGoesOffStandAtTheirOffValueAndClaimNothing) {
  const TuneResult r = tuned({}, 4);
  std::map<std::string, bool> effects = kept(r);
  int rows = 0;
  for (const EffectInfo& e : effect_list())
    for (const EffectParameter& p : e.parameters)
      if (effects.contains(e.name) && !effects[e.name] && p.switches) {
        ++rows;
        EXPECT_EQ(r.table[r.table.find(p.name)].nominal, p.off) << p.name;
        for (const ParameterResult& row : r.parameters)
          if (row.name == p.name) {
            EXPECT_NE(row.verdict, RowVerdict::bounded) << p.name;
          }
      }
  EXPECT_GT(rows, 0);
}

TEST(EarnedEffects, WhatIsAskedForStaysFree) {
  TuneOptions o;
  o.effects = {MagneticHysteresis::name};
  EXPECT_TRUE(tuned({}, 5, o).effects.empty());
}

}  // namespace
}  // namespace servodx
