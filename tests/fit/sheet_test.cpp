// The data sheet's step and frequency response, met before any log (GA paper, "Servovalve simulation design": frequency
// response tune-up, step response tune-up).
#include "fit/sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/data_sheet.h"
#include "servodx/rig.h"
#include "shipped_data.h"

namespace servodx {
namespace {

constexpr double degree = std::numbers::pi / 180;

Table textbook() { return read_table(shipped("params/borello2009.csv")); }

// What `servodx rig --facts` measures of the flight valve; the points' own reading is from the same stand.
RigFile with_dynamics() {
  RigFile rig = shipped_rig();
  rig.facts["valve.step_rise_time"] = 7.3e-3;
  rig.response.push_back({.frequency = 60, .amplitude = 0.1, .gain = -3.0, .phase_lag = {}});
  rig.response.push_back({.frequency = 107, .amplitude = 0.4, .gain = {}, .phase_lag = 90 * degree});
  return rig;
}

TEST(DataSheet, StepAndFrequencyResponseAreMetBeforeAnyLog) {
  const SheetFit sheet = data_sheet(textbook(), with_dynamics());
  ASSERT_EQ(sheet.figures.size(), 4u) << "and the phase lag of 90 degrees";
  EXPECT_EQ(sheet.rows_are, SheetRows::fitted);
  EXPECT_GT(farthest(sheet.figures, sheet.before), 2.0) << "what the formulas make of the sheet misses it";
  EXPECT_LT(farthest(sheet.figures, sheet.after), 1.0);
}

TEST(DataSheet, OnlyTheFiveRowsThatItTellsMoveAndSayWhy) {
  const RigFile rig = with_dynamics();
  const Table before = apply_rig_facts(textbook(), shipped_rig()), after = apply_rig_facts(textbook(), rig);
  const std::vector<int> told = {row::flapper_stiffness, row::torque_motor_frequency, row::hydraulic_amplifier_gain,
                                 row::fixed_orifice_diameter, row::driver_bandwidth};
  for (int i = 0; i < n_parameters; ++i) {
    const bool may = std::find(told.begin(), told.end(), i) != told.end();
    EXPECT_EQ(after[i].source.find("valve.step_rise_time") != std::string::npos, may && before[i].estimate)
        << after[i].name;
    if (!may) {
      EXPECT_EQ(after[i].nominal, before[i].nominal) << after[i].name;
    }
    EXPECT_GE(after[i].nominal, before[i].lower) << after[i].name;
    EXPECT_LE(after[i].nominal, before[i].upper) << after[i].name;
  }
  EXPECT_NE(after[row::flapper_stiffness].nominal, before[row::flapper_stiffness].nominal);
}

TEST(DataSheet, AValveOfTheModelIsFoundAgainByItsFigures) {
  // A stiffer armature behind a slower amplifier, its figures as a maker would print them.
  RigFile rig = shipped_rig();
  rig.facts["valve.step_rise_time"] = 1;
  for (const double f : {20.0, 60.0, 120.0}) rig.response.push_back({.frequency = f, .gain = 0, .phase_lag = 1});
  rig.facts.erase("valve.phase_lag_90_frequency");
  Table truth = apply_rig_facts(textbook(), shipped_rig());
  truth[row::flapper_stiffness].nominal *= 1.3;
  truth[row::driver_bandwidth].nominal *= 0.6;
  rig.facts["valve.step_rise_time"] = 9e-3;  // the window that it is read in
  const SheetFit printed = beside_sheet(truth, rig, false);
  rig.facts["valve.step_rise_time"] = printed.after[0];
  for (std::size_t k = 0; k < rig.response.size(); ++k) {
    rig.response[k].gain = printed.after[1 + 2 * k];
    rig.response[k].phase_lag = printed.after[2 + 2 * k];
  }
  const SheetFit found = data_sheet(textbook(), rig);
  EXPECT_LT(farthest(found.figures, found.after), 0.3) << "of " << farthest(found.figures, found.before);
}

// "Preliminary sensitivity trials showed that hydraulic gain parameter has the most significant influence": the speed
// of the spool per travel of the flapper. Rows 6, 8 and 13 make it; a tenth more of it is a tenth less of the spool's
// area.
TEST(DataSheet, TheHydraulicGainMattersMost) {
  const RigFile rig = with_dynamics();
  const SheetFit sheet = data_sheet(textbook(), rig);
  Table faster = apply_rig_facts(textbook(), rig);
  faster[row::spool_diameter].nominal /= std::sqrt(1.1);
  const SheetFit moved = beside_sheet(faster, rig, false);
  double square = 0;
  for (std::size_t k = 0; k < sheet.figures.size(); ++k)
    square += std::pow((moved.after[k] - sheet.after[k]) / sheet.figures[k].tolerance, 2);
  EXPECT_GT(std::sqrt(square), sheet.rows.front().tells) << "any of the five rows by itself";
  EXPECT_EQ(sheet.rows.back().position, row::torque_motor_frequency);
  EXPECT_EQ(sheet.rows[3].position, row::driver_bandwidth) << "behind what makes the loop's gain: rows 4, 6 and 8";
}

TEST(DataSheet, RowsThatATableHoldsStay) {
  Table held = textbook();
  held[row::driver_bandwidth].estimate = false;
  EXPECT_EQ(apply_rig_facts(held, with_dynamics())[row::driver_bandwidth].nominal, held[row::driver_bandwidth].nominal);
}

TEST(DataSheet, APhaseLagAloneKeepsTheFormula) {
  const SheetFit sheet = data_sheet(textbook(), shipped_rig());
  EXPECT_EQ(sheet.rows_are, SheetRows::formulas);
  ASSERT_EQ(sheet.figures.size(), 1u);
  EXPECT_EQ(sheet.before, sheet.after);
}

TEST(DataSheet, ATunedTableIsCompared) {
  Table tuned = apply_rig_facts(textbook(), shipped_rig());
  tuned.has_std_error = true;
  const SheetFit sheet = data_sheet(tuned, with_dynamics());
  EXPECT_EQ(sheet.rows_are, SheetRows::tuned);
  for (const SheetRow& r : sheet.rows) EXPECT_EQ(r.before, r.after);
  EXPECT_EQ(sheet.before, sheet.after);
}

}  // namespace
}  // namespace servodx
