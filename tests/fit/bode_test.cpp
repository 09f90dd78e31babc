// A valve's Bode plot by sines on a stand: what a fault does to it, and where its bandwidth is read.
#include "fit/bode.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "faults/registry.h"
#include "fit/candidate_of.h"
#include "fit/log_data.h"
#include "fit/sheet.h"
#include "parameters/table.h"
#include "servodx/bode.h"
#include "servodx/data_sheet.h"
#include "servodx/rig.h"
#include "shipped_data.h"
#include "simulate/scenario.h"

namespace servodx {
namespace {

Table textbook() { return read_table(shipped("params/borello2009.csv")); }

std::vector<Bode> with_fault(const char* name, double severity) {
  const ParameterVector tuned = candidate_of(textbook());
  ParameterVector worn = tuned;
  find_fault(name)->apply(worn.data(), severity);
  return bode_of({{"as tuned", tuned}, {name, worn}}, RigFile{});
}

TEST(Bode, ATunedValveBeginsAtNothingAndLagsMoreAndMore) {
  const std::vector<Bode> bodes = with_fault("torque_motor_loss", 1);
  ASSERT_EQ(bodes.size(), 2u);
  for (const Bode& bode : bodes) {
    const BodeLine& line = bode.lines.front();
    EXPECT_NEAR(line.gain.front(), 0, 1e-9);
    for (std::size_t k = 1; k < line.phase.size(); ++k) EXPECT_LT(line.phase[k], line.phase[k - 1] + 0.02) << k;
    for (std::size_t k = 0; k < line.gain.size(); ++k)  // the fault's healthy end moves nothing
      EXPECT_EQ(line.gain[k], bode.lines.back().gain[k]) << k;
  }
}

TEST(Bode, AWeakMotorLosesGainByWhatItLost) {
  for (const Bode& bode : with_fault("torque_motor_loss", 0.5))
    EXPECT_NEAR(bode.lines.back().gain.front(), 20 * std::log10(0.5), 0.3) << bode.amplitude;
}

// A wire that plays by a tenth of a small sine hardly plays against a large one.
TEST(Bode, BacklashShowsAtTheSmallAmplitude) {
  const std::vector<Bode> bodes = with_fault("feedback_wire_backlash", 20e-6);
  const auto moved = [](const Bode& b) { return std::abs(b.lines[1].gain.front() - b.lines[0].gain.front()); };
  EXPECT_GT(moved(bodes.front()), 1.0);
  EXPECT_GT(moved(bodes.front()), 3 * moved(bodes.back()));
}

// The sheet's own reading of the same stand: one law of lag.
TEST(Bode, LagsByNinetyDegreesWhereTheSheetReadsIt) {
  const Table table = textbook();
  const std::vector<Bode> bodes = bode_of({{"as tuned", candidate_of(table)}}, RigFile{});
  const auto lag_90 = bandwidth_of(bodes.back(), bodes.back().lines.front()).lag_90;
  ASSERT_TRUE(lag_90);
  RigFile rig;
  rig.facts["valve.phase_lag_90_frequency"] = *lag_90;  // read at +-40 %
  const SheetFit sheet = beside_sheet(table, rig, false);
  ASSERT_EQ(sheet.after.size(), 1u);
  EXPECT_NEAR(sheet.after.front() * 180 / std::numbers::pi, 90, 2);
}

TEST(Bode, BandwidthIsReadBetweenPointsAndNoneWhereTheLineDoesNotFall) {
  const Bode bode{0.1, {10, 100, 1000}, {{"falls", {0, -6, -20}, {0, -2, -4}}, {"stays", {0, 0, 0}, {0, 0, 0}}}};
  const Bandwidth falls = bandwidth_of(bode, bode.lines[0]), stays = bandwidth_of(bode, bode.lines[1]);
  EXPECT_NEAR(*falls.gain_3_db, 10 * std::sqrt(10), 1e-9);
  EXPECT_NEAR(*falls.lag_90, 10 * std::pow(10, std::numbers::pi / 4), 1e-9);
  EXPECT_FALSE(stays.gain_3_db || stays.lag_90);
}

}  // namespace
}  // namespace servodx
