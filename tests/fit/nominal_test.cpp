#include "fit/nominal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.h"
#include "fit/free_values.h"
#include "model/constants.h"
#include "parameters/list.h"
#include "parameters/table.h"
#include "servodx/data_sheet.h"
#include "servodx/rig.h"

namespace servodx {
namespace {

static_assert(nominal::cd_metering == constants::cd_metering);
static_assert(nominal::cd_orifice == constants::cd_orifice);
static_assert(nominal::cd_nozzle == constants::cd_nozzle);
static_assert(nominal::clean_filter_area_ratio == constants::clean_filter_area_ratio);
static_assert(nominal::slot_resistance == constants::slot_resistance);
static_assert(nominal::jet_angle_factor == constants::jet_angle_factor);

Table shipped() { return read_table(std::string(SERVODX_SOURCE_DIR) + "/params/borello2009.csv"); }

RigFile rig_with(std::map<std::string, double> facts) {
  RigFile rig;
  rig.path = "rig.toml";
  rig.facts = std::move(facts);
  return rig;
}

const std::map<std::string, double> flight_sheet = {
    {"valve.rated_current", 0.020},
    {"valve.spool_stroke", 0.5e-3},
    {"valve.spool_stop", 0.58e-3},
    {"valve.spool_diameter", 6.5e-3},
    {"valve.no_load_flow", 14.0 / 60000},
    {"valve.phase_lag_90_frequency", 100},
    {"valve.null_leakage", 0.8 / 60000},
    {"valve.pilot_leakage", 0.4 / 60000},
    {"valve.radial_clearance", 3.5e-6},
    {"valve.nozzle_diameter", 0.34e-3},
    {"valve.fixed_orifice_diameter", 0.2e-3},
    {"valve.nozzle_gap", 35e-6},
    {"valve.torque_motor_frequency", 750},
    {"actuator.area_a", 7.88e-4},
    {"actuator.area_b", 7.88e-4},
    {"actuator.stroke", 0.4},
    {"actuator.moving_mass", 10},
    {"supply.pressure", 207e5},
    {"supply.return_pressure", 5e5},
};

TEST(RigFacts, FrictionsAndVolumesGrowWithTheCylinder) {
  // Twice the area, twice the flow: the same speed at twice the force.
  std::map<std::string, double> sheet = flight_sheet, large = flight_sheet;
  for (const char* key : {"actuator.area_a", "actuator.area_b", "valve.no_load_flow"}) large[key] *= 2;
  const Table of_sheet = apply_rig_facts(shipped(), rig_with(sheet)),
              of_large = apply_rig_facts(shipped(), rig_with(large));
  for (const int r :
       {row::piston_coulomb_friction, row::piston_viscous_friction, row::dead_volume_a, row::dead_volume_b}) {
    EXPECT_NEAR(of_large[r].nominal / of_sheet[r].nominal, 2, 1e-3) << of_sheet[r].name;
    EXPECT_NEAR(of_large[r].upper / of_sheet[r].upper, 2, 1e-3) << of_sheet[r].name;
  }
  large["actuator.dead_volume_a"] = 3e-5;
  EXPECT_DOUBLE_EQ(apply_rig_facts(shipped(), rig_with(large))[row::dead_volume_a].nominal, 3e-5) << "as stated";
  large.erase("actuator.area_a");
  large.erase("actuator.area_b");
  EXPECT_EQ(apply_rig_facts(shipped(), rig_with(large))[row::piston_coulomb_friction].nominal,
            shipped()[row::piston_coulomb_friction].nominal)
      << "nothing is known of the cylinder";
}

TEST(RowsOffDrawing, AreThoseThatTheSheetStatesAndThatEndedAtTheEndOfTheirRange) {
  const RigFile rig = rig_with(flight_sheet);
  const Table nominal = apply_rig_facts(shipped(), rig);
  Table tuned = nominal;
  EXPECT_TRUE(rows_off_drawing(tuned, nominal, rig).empty());
  tuned[row::radial_clearance].nominal = tuned[row::radial_clearance].lower;
  tuned[row::port_width].nominal = tuned[row::port_width].upper;
  tuned[row::cross_piston_leakage].nominal = tuned[row::cross_piston_leakage].lower;  // no sheet states it
  const auto off = rows_off_drawing(tuned, nominal, rig);
  ASSERT_EQ(off.size(), 2u);
  for (const OffDrawing& one : off) {
    const int at = one.row == "port_width" ? row::port_width : row::radial_clearance;
    EXPECT_DOUBLE_EQ(one.times, tuned[at].nominal / nominal[at].nominal) << one.row;
  }
  auto silent = flight_sheet;
  silent.erase("valve.radial_clearance");
  EXPECT_EQ(rows_off_drawing(tuned, nominal, rig_with(silent)).size(), 1u) << "a sheet that does not state it";
  tuned[row::port_width].estimate = false;
  EXPECT_EQ(rows_off_drawing(tuned, nominal, rig_with(silent)).size(), 0u) << "it was held";
}

// But for the loop's gain: the paper's valve has 89 Hz for its 100 Hz of lag, a sheet alone gives two thirds.
TEST(RigFacts, TheFlightSheetGivesTheShippedTable) {
  const Table before = shipped(), after = apply_rig_facts(before, rig_with(flight_sheet));
  const double wire = before[row::feedback_wire_stiffness].nominal;
  for (int i = 0; i < n_parameters; ++i) {
    if (i == row::flapper_stiffness) continue;
    EXPECT_NEAR(after[i].nominal, before[i].nominal, 0.02 * std::abs(before[i].nominal)) << before[i].name;
  }
  EXPECT_NEAR((after[row::flapper_stiffness].nominal + wire) / (before[row::flapper_stiffness].nominal + wire),
              89 / 66.7, 0.02 * 89 / 66.7);
}

TEST(RigFacts, EveryFactOfTheSheetMovesARow) {
  std::map<std::string, double> quiet = flight_sheet;
  quiet["lines.length"] = 0.45;
  quiet["lines.bore"] = 10e-3;
  quiet["actuator.dead_volume_a"] = 2e-5;
  quiet["actuator.dead_volume_b"] = 2e-5;
  const Table before = apply_rig_facts(shipped(), rig_with(quiet));
  for (const auto& [key, value] : quiet) {
    auto facts = quiet;
    if (key == "valve.pilot_leakage") facts.erase("valve.fixed_orifice_diameter");
    if (key == "valve.null_leakage") facts.erase("valve.radial_clearance");
    facts[key] = key == "valve.null_leakage" ? 0.41 / 60000 : 1.1 * value;
    const Table after = apply_rig_facts(shipped(), rig_with(facts));
    bool moved = false;
    for (int i = 0; i < n_parameters; ++i) moved = moved || after[i].nominal != before[i].nominal;
    EXPECT_TRUE(moved) << key;
  }
}

// A velocity head each: half the density over the area squared.
TEST(RigFacts, FittingsTakeThePlaceOfTheUsualLosses) {
  const double area = std::numbers::pi / 4 * 1e-4;
  std::map<std::string, double> facts = {{"lines.length", 0.45}, {"lines.bore", 10e-3}};
  RigFile usual = rig_with(facts);
  facts["lines.loss"] = 5;
  RigFile listed = rig_with(facts);
  listed.words["lines.fittings"] = "entrance, elbow_90, elbow_90, elbow_90";
  std::vector<std::string> where_from;
  const double before = apply_rig_facts(shipped(), usual)[row::hose_resistance].nominal,
               after = apply_rig_facts(shipped(), listed, &where_from)[row::hose_resistance].nominal;
  EXPECT_NEAR(after - before, 3 * usual.fluid.density / (2 * area * area), 1e-3 * after);
  EXPECT_NE(where_from.front().find("elbow_90"), std::string::npos) << where_from.front();
  EXPECT_THROW(apply_rig_facts(shipped(), rig_with({{"lines.loss", 5}})), InputError);
}

TEST(RigFacts, OverriddenRowsNameTheirKeyAndTheRestKeepTheirSource) {
  std::vector<std::string> where_from;
  const Table before = shipped();
  const Table after = apply_rig_facts(before, rig_with({{"valve.nozzle_diameter", 0.4e-3}}), &where_from);
  EXPECT_EQ(after[row::hydraulic_amplifier_gain].source, "rig.toml: valve.nozzle_diameter");
  EXPECT_NEAR(after[row::hydraulic_amplifier_gain].nominal, std::numbers::pi * 0.4e-3, 1e-7);
  ASSERT_EQ(where_from.size(), 1u);
  EXPECT_EQ(where_from[0],
            "hydraulic_amplifier_gain = 0.0012566 m: rig.toml: valve.nozzle_diameter; pi * nozzle_diameter");
  for (int i = 0; i < n_parameters; ++i) {
    if (i == row::hydraulic_amplifier_gain) continue;
    EXPECT_EQ(after[i].source, before[i].source);
    EXPECT_EQ(after[i].nominal, before[i].nominal);
  }
}

TEST(RigFacts, AnEmptyRigFileChangesNothing) {
  std::vector<std::string> where_from;
  const Table before = shipped(), after = apply_rig_facts(before, rig_with({}), &where_from);
  EXPECT_TRUE(where_from.empty());
  for (int i = 0; i < n_parameters; ++i) {
    EXPECT_EQ(after[i].nominal, before[i].nominal);
    EXPECT_EQ(after[i].lower, before[i].lower);
    EXPECT_EQ(after[i].upper, before[i].upper);
  }
}

TEST(RigFacts, RatedCurrentReachesTheRatedStroke) {
  const Table t =
      apply_rig_facts(shipped(), rig_with({{"valve.rated_current", 0.010}, {"valve.spool_stroke", 0.8e-3}}));
  EXPECT_NEAR(t[row::torque_motor_gain].nominal * 0.010 / t[row::feedback_wire_stiffness].nominal, 0.8e-3, 1e-9);
  EXPECT_NEAR(t[row::current_limit].nominal, 0.015, 1e-12);
  EXPECT_GT(t[row::spool_stop].nominal, 0.8e-3);
  EXPECT_NEAR(t[row::torque_motor_gain].lower, 0.05 * t[row::torque_motor_gain].nominal, 1e-6);
  // without the stroke, the table's implied stroke stays
  const Table u = apply_rig_facts(shipped(), rig_with({{"valve.rated_current", 0.010}}));
  EXPECT_NEAR(u[row::torque_motor_gain].nominal * 0.010 / u[row::feedback_wire_stiffness].nominal, 0.5e-3, 1e-9);
}

TEST(RigFacts, RatedFlowAndNoLoadFlowGiveTheSamePortWidth) {
  const double flow = 14.0 / 60000, supplied = 202e5, rated = 70e5;
  const Table a = apply_rig_facts(shipped(), rig_with({{"valve.no_load_flow", flow}}));
  const Table b = apply_rig_facts(shipped(), rig_with({{"valve.rated_flow", flow * std::sqrt(rated / supplied)},
                                                       {"valve.rated_pressure_drop", rated}}));
  EXPECT_NEAR(a[row::port_width].nominal, b[row::port_width].nominal, 1e-4 * a[row::port_width].nominal);
  EXPECT_EQ(b[row::port_width].source, "rig.toml: valve.rated_flow");
}

TEST(RigFacts, PilotLeakageSizesTheOrificeWhereNoDiameterIsGiven) {
  const Table t = apply_rig_facts(shipped(), rig_with({{"valve.pilot_leakage", 0.45 / 60000}}));
  // the shipped orifice passes 0.447 l/min
  EXPECT_NEAR(t[row::fixed_orifice_diameter].nominal, shipped()[row::fixed_orifice_diameter].nominal, 3e-6);
}

TEST(RigFacts, HigherPhaseLagFrequencyAsksForASofterFlapper) {
  const auto stiffness = [](double f) {
    return apply_rig_facts(shipped(), rig_with({{"valve.phase_lag_90_frequency", f}}))[row::flapper_stiffness].nominal;
  };
  EXPECT_GT(stiffness(60), stiffness(100));
  EXPECT_GT(stiffness(100), stiffness(200));
  // K_v (k_f + k_w) = G k_w whatever the frequency
  const double kw = shipped()[row::feedback_wire_stiffness].nominal;
  EXPECT_NEAR((stiffness(60) + kw) * 60, (stiffness(200) + kw) * 200, 1e-3 * (stiffness(60) + kw) * 60);
}

// A soft flapper hardly moves the loop: a factor about its stiffness would leave slow valves out.
TEST(RigFacts, AFlapperMayBeSoStiffThatTheLoopIsAQuarterOfTheSheets) {
  const auto upper_over_nominal = [](double f) {
    const Table t = apply_rig_facts(shipped(), rig_with({{"valve.phase_lag_90_frequency", f}}));
    const double wire = t[row::feedback_wire_stiffness].nominal;
    return (t[row::flapper_stiffness].upper + wire) / (t[row::flapper_stiffness].nominal + wire);
  };
  for (double f : {40.0, 100.0, 200.0}) EXPECT_NEAR(upper_over_nominal(f), 4, 1e-3) << f;
}

TEST(RigFacts, MountStiffnessStartsTheEffectOnlyWhereTheTableHasItsRow) {
  Table table = shipped();
  const RigFile rig = rig_with({{"actuator.mount_stiffness", 3.1e7}});
  EXPECT_EQ(apply_rig_facts(table, rig).rows.size(), 41u);
  Row row;
  row.name = "mount_compliance";
  row.group = "effect:mount_compliance";
  row.unit = "m/N";
  row.upper = 3e-7;
  table.rows.push_back(row);
  EXPECT_NEAR(apply_rig_facts(table, rig)[41].nominal, 1 / 3.1e7, 1e-12);
}

TEST(RigFacts, EveryResultIsATableThatReadsBack) {
  const Table t = apply_rig_facts(shipped(), rig_with(flight_sheet));
  for (const Row& row : t.rows) {
    EXPECT_LE(row.lower, row.nominal) << row.name;
    EXPECT_GE(row.upper, row.nominal) << row.name;
    EXPECT_TRUE(!row.log_scale || row.lower > 0) << row.name;
    EXPECT_LT(row.lower, row.upper) << row.name;
  }
}

TEST(RigFacts, ATunedTableKeepsItsValues) {
  Table tuned = shipped();
  tuned.has_std_error = true;
  std::vector<std::string> where_from;
  const Table after = apply_rig_facts(tuned, rig_with(flight_sheet), &where_from);
  EXPECT_EQ(after[row::flapper_stiffness].source, tuned[row::flapper_stiffness].source);
  EXPECT_EQ(where_from.size(), 1u);
}

TEST(RigFacts, ContradictionsAreRefusedAtTheirKey) {
  const auto refused_at = [](const RigFile& rig) -> std::string {
    try {
      apply_rig_facts(shipped(), rig);
    } catch (const InputError& e) {
      EXPECT_FALSE(e.mend.empty());
      const std::size_t from = e.rule.find("key '"), to = e.rule.find("': ");
      return from == 0 && to != std::string::npos ? e.rule.substr(5, to - 5) : "no key";
    }
    return "not refused";
  };
  RigFile jet = rig_with({});
  jet.words["valve.first_stage"] = "jet_pipe";
  EXPECT_EQ(refused_at(jet), "valve.first_stage");
  EXPECT_EQ(refused_at(rig_with({{"valve.spool_stop", 0.4e-3}})), "valve.spool_stop");
  EXPECT_EQ(refused_at(rig_with({{"valve.phase_lag_90_frequency", 900}})), "valve.phase_lag_90_frequency");
  EXPECT_EQ(refused_at(rig_with({{"valve.pilot_leakage", 1.0 / 60000}, {"valve.nozzle_diameter", 0.34e-3}})),
            "valve.pilot_leakage");
  // Nozzles that nobody stated are as wide as it takes.
  EXPECT_EQ(refused_at(rig_with({{"valve.pilot_leakage", 1.0 / 60000}})), "not refused");
  EXPECT_EQ(refused_at(rig_with({{"valve.null_leakage", 0.3 / 60000}, {"valve.pilot_leakage", 0.4 / 60000}})),
            "valve.null_leakage");
  EXPECT_EQ(refused_at(rig_with({{"supply.pressure", 4e5}})), "supply.pressure");
  EXPECT_EQ(refused_at(rig_with({{"lines.length", 0.45}})), "lines.length");
}

}  // namespace
}  // namespace servodx
