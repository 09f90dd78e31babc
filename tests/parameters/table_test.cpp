#include "parameters/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <numbers>
#include <sstream>

#include "base/error.h"
#include "base/reading_limits.h"
#include "parameters/coordinate.h"
#include "parameters/list.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

const std::string borello = std::string(SERVODX_SOURCE_DIR) + "/params/borello2009.csv";
const std::string bench = std::string(SERVODX_SOURCE_DIR) + "/params/bench.csv";

class TableFile : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / (std::string("servodx_table_") + info->name() + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name = "t.csv") const { return (folder_ / name).string(); }

  static std::string text_of(const std::string& file) {
    std::ostringstream out;
    out << std::ifstream(file, std::ios::binary).rdbuf();
    return out.str();
  }

  std::string written(const std::string& text) const {
    std::ofstream(path(), std::ios::binary) << text;
    return path();
  }

  // The shipped table with `from` replaced by `to` in the row of that id.
  std::string edited(int id, const std::string& from, const std::string& to) const {
    std::istringstream in(text_of(borello));
    std::string out, line;
    bool done = false;
    while (std::getline(in, line)) {
      if (line.starts_with(std::to_string(id) + ",")) {
        const auto at = line.find(from);
        EXPECT_NE(at, std::string::npos) << line;
        line.replace(at, from.size(), to);
        done = true;
      }
      out += line + "\n";
    }
    EXPECT_TRUE(done);
    return written(out);
  }

  static InputError refusal(const std::string& file) {
    try {
      read_table(file);
    } catch (const InputError& e) {
      EXPECT_FALSE(e.mend.empty());
      EXPECT_EQ(e.where.file, file);
      return e;
    }
    ADD_FAILURE() << "not refused: " << file;
    return InputError({}, "", "");
  }

  fs::path folder_;
};

long line_of(int id) { return id + 4; }  // three comments and the header come first

class ShippedTables : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Both, ShippedTables, ::testing::Values(borello, bench),
                         [](const auto& file) { return fs::path(file.param).stem().string(); });

TEST_P(ShippedTables, HoldThe41RowsEachWithUnitAndSource) {
  const Table table = read_table(GetParam());
  ASSERT_EQ(table.rows.size(), 41u);
  EXPECT_FALSE(table.has_std_error);
  EXPECT_EQ(table.sha256.size(), 64u);
  for (int i = 0; i < n_parameters; ++i) {
    EXPECT_EQ(table[i].id, i + 1);
    EXPECT_EQ(table[i].unit, parameter_list[i].unit);
    EXPECT_EQ(table[i].description, parameter_list[i].meaning);
    EXPECT_GT(table[i].source.size(), 5u) << table[i].name;
    EXPECT_LT(table[i].lower, table[i].upper) << table[i].name;
  }
}

TEST(ShippedTable, RowsFixedByThePaperKeepTheirNumbers) {
  EXPECT_EQ(find_parameter("filter_blockage_positive"), 0);
  EXPECT_EQ(find_parameter("filter_blockage_negative"), 1);
  EXPECT_EQ(find_parameter("hydraulic_amplifier_gain"), 5);
  EXPECT_EQ(find_parameter("valve_glitch"), 8);
  EXPECT_EQ(find_parameter("servovalve_null"), 40);
}

TEST(ShippedTable, ActuatorGroupHasThirteenRows) {
  int n = 0;
  for (const auto& p : parameter_list) n += p.group == Group::actuator;
  EXPECT_EQ(n, 13);
}

TEST_P(ShippedTables, LeaveRoomForEveryFault) {
  const Table t = read_table(GetParam());
  EXPECT_GE(t[row::filter_blockage_positive].upper, 0.98);
  EXPECT_GE(t[row::filter_blockage_negative].upper, 0.98);
  EXPECT_LE(t[row::torque_motor_gain].lower, 0.05 * t[row::torque_motor_gain].nominal);
  EXPECT_EQ(t[row::feedback_wire_stiffness].lower, 0);
  EXPECT_GE(t[row::valve_glitch].upper, 1e-4);
  EXPECT_GE(t[row::spool_friction].upper, 30 * t[row::spool_friction].nominal);
  EXPECT_GE(t[row::radial_clearance].upper, 11.99 * t[row::radial_clearance].nominal);
  EXPECT_EQ(t[row::servovalve_null].upper, 0.35);
}

TEST(ShippedTable, ObeysTheStaticsOfItsOwnSources) {
  const Table t = read_table(borello);
  const auto v = [&](int i) { return t[i].nominal; };
  // rated current moves the spool 0.5 mm
  EXPECT_NEAR(v(row::torque_motor_gain) * 0.020 / v(row::feedback_wire_stiffness), 0.5e-3, 1e-9);
  const double density = 860, dp = v(row::supply_pressure) - v(row::return_pressure);
  // 14 l/min without load, and 300 mm/s within 2 %
  const double flow = 0.61 * v(row::port_width) * 0.5e-3 * std::sqrt(dp / density);
  EXPECT_NEAR(flow * 60000, 14.0, 0.02);
  EXPECT_NEAR(flow / v(row::piston_area_a), 0.300, 0.006);
  // stall 16 kN at 20.7 MPa within 2 %
  EXPECT_NEAR(dp * v(row::piston_area_a), 16000, 320);
  // pilot pressure between 1/2 and 2/3 of the supply (GA fault diagnosis)
  const double orifice = std::numbers::pi / 4 * std::pow(v(row::fixed_orifice_diameter), 2);
  const double curtain = v(row::hydraulic_amplifier_gain) * v(row::nozzle_gap);
  const double pilot = v(row::return_pressure) + dp / (1 + std::pow(curtain / orifice, 2));
  EXPECT_GT(pilot, v(row::supply_pressure) / 2);
  EXPECT_LT(pilot, v(row::supply_pressure) * 2 / 3);
  // loop gain of the wire 80 to 100 Hz
  const double area = std::numbers::pi / 4 * std::pow(v(row::spool_diameter), 2);
  const double gain =
      0.64 * v(row::hydraulic_amplifier_gain) * std::sqrt(2 * (pilot - v(row::return_pressure)) / density) / area;
  const double kw = v(row::feedback_wire_stiffness);
  const double hertz = gain * kw / (kw + v(row::flapper_stiffness)) / (2 * std::numbers::pi);
  EXPECT_GT(hertz, 80);
  EXPECT_LT(hertz, 100);
}

TEST(ShippedTable, OfTheBenchObeysTheStaticsOfItsOwnSources) {
  const Table t = read_table(bench);
  const auto v = [&](int i) { return t[i].nominal; };
  const double pi = std::numbers::pi, density = 868;
  // rated current moves the spool 0.7 mm, and that passes 40 l/min at 70 bar
  EXPECT_NEAR(v(row::torque_motor_gain) * 0.050 / v(row::feedback_wire_stiffness), 0.7e-3, 1e-9);
  EXPECT_NEAR(0.61 * v(row::port_width) * 0.7e-3 * std::sqrt(70e5 / density) * 60000, 40.0, 0.05);
  // a cylinder of 50/36 mm
  EXPECT_NEAR(v(row::piston_area_a), pi / 4 * 0.050 * 0.050, 1e-7);
  EXPECT_NEAR(v(row::piston_area_b), pi / 4 * (0.050 * 0.050 - 0.036 * 0.036), 1e-7);
  EXPECT_EQ(v(row::supply_pressure), 140e5);
  // pilot pressure between 1/2 and 2/3 of the supply
  const double dp = v(row::supply_pressure) - v(row::return_pressure);
  const double orifice = 0.65 * pi / 4 * std::pow(v(row::fixed_orifice_diameter), 2);
  const double curtain = 0.64 * v(row::hydraulic_amplifier_gain) * v(row::nozzle_gap);
  const double pilot = dp / (1 + 1.04 * std::pow(curtain / orifice, 2));
  EXPECT_GT(v(row::return_pressure) + pilot, v(row::supply_pressure) / 2);
  EXPECT_LT(v(row::return_pressure) + pilot, v(row::supply_pressure) * 2 / 3);
  // the wire closes the loop at 0.9 of 60 Hz
  const double gain = 0.64 * v(row::hydraulic_amplifier_gain) * std::sqrt(2 * pilot / density) /
                      (pi / 4 * std::pow(v(row::spool_diameter), 2));
  const double kw = v(row::feedback_wire_stiffness);
  EXPECT_NEAR(gain * kw / (kw + v(row::flapper_stiffness)) / (2 * pi), 54, 1);
}

TEST_F(TableFile, WrittenAndReadAgainIsTheSameTable) {
  Table table = read_table(borello);
  table.comments = {"tuned from: h01.csv", "seed: 7"};
  table.has_std_error = true;
  table[row::bulk_modulus].nominal = 1.0 / 3.0 * 4e9;
  table[row::bulk_modulus].std_error = 0.1 + 0.2;
  table[row::bulk_modulus].source = "a \"quoted\" source, with a comma\nand a line end";
  Row effect;
  effect.name = "delay";
  effect.group = "effect:transport_delay";
  effect.upper = 1e-2;
  effect.unit = "s";
  effect.estimate = true;
  table.rows.push_back(effect);
  write_table(path(), table);
  const Table again = read_table(path());
  ASSERT_EQ(again.rows.size(), 42u);
  EXPECT_EQ(again.comments, table.comments);
  EXPECT_TRUE(again.has_std_error);
  for (std::size_t i = 0; i < again.rows.size(); ++i) {
    const Row &a = again.rows[i], &b = table.rows[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.group, b.group);
    EXPECT_EQ(a.nominal, b.nominal);
    EXPECT_EQ(a.lower, b.lower);
    EXPECT_EQ(a.upper, b.upper);
    EXPECT_EQ(a.log_scale, b.log_scale);
    EXPECT_EQ(a.estimate, b.estimate);
    EXPECT_EQ(a.unit, b.unit);
    EXPECT_EQ(a.source, b.source);
    EXPECT_EQ(a.std_error, b.std_error);
  }
  EXPECT_EQ(again.find("delay"), 41);
  EXPECT_EQ(again.find("no such row"), -1);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator{}), 1) << "temporary file left";
}

TEST_F(TableFile, AcceptsByteOrderMarkCrLfAndAnyRowOrder) {
  std::istringstream in(text_of(borello));
  std::string line, header, rows;
  while (std::getline(in, line)) {
    if (line.starts_with("#")) continue;
    if (header.empty())
      header = line + "\r\n";
    else
      rows = line + "\r\n" + rows;
  }
  const Table table = read_table(written("\xEF\xBB\xBF" + header + rows));
  EXPECT_EQ(table[0].name, "filter_blockage_positive");
  EXPECT_EQ(table[40].name, "servovalve_null");
}

TEST_F(TableFile, UpperBelowLowerIsRefusedWithPlaceRuleAndMend) {
  const auto e = refusal(edited(38, "1400000000,700000000,2200000000", "1.3e9,1.2e9,0.9e9"));
  EXPECT_EQ(e.where.line, line_of(38));
  EXPECT_EQ(e.where.column, "upper");
  EXPECT_EQ(e.rule, "'bulk_modulus' upper (9e+08 Pa) is below lower (1.2e+09 Pa)");
  EXPECT_EQ(e.mend, "swap them or widen 'upper'");
}

TEST_F(TableFile, WhatNoMachineHasIsRefused) {
  const auto area = refusal(edited(23, "0.000788,0.0006304,0.0009456,log10", "-0.000788,-0.0009,-0.0006,lin"));
  EXPECT_EQ(area.where.line, line_of(23));
  EXPECT_EQ(area.rule, "'piston_area_a' is -0.000788 m2, and there is none of 0 or less");
  EXPECT_EQ(area.mend, "write a positive value");
  const auto volume = refusal(edited(27, "2e-05,4e-06,0.0001,log10", "0,0,0.0001,lin"));
  EXPECT_EQ(volume.where.line, line_of(27));
  EXPECT_EQ(volume.rule, "'dead_volume_a' is 0 m3, and there is none of 0 or less");
  const auto bound = refusal(edited(32, "150,0,2000", "150,-10,2000"));
  EXPECT_EQ(bound.where.line, line_of(32));
  EXPECT_EQ(bound.where.column, "lower");
  EXPECT_EQ(bound.rule, "'piston_coulomb_friction' may go down to -10 N, and is never negative");
  const auto back = refusal(edited(37, "500000,0,5000000", "3e7,0,4e7"));
  EXPECT_EQ(back.where.line, line_of(37));
  EXPECT_EQ(back.mend, "check both values");
}

TEST_F(TableFile, EachRefusalNamesPlaceRuleAndMend) {
  const struct {
    int id;
    const char *from, *to, *message;
  } cases[] = {
      {3, "torque_motor_gain", "torque_gain",
       "t.csv:7: column 'name': row 3 is 'torque_motor_gain', not 'torque_gain'; write 'torque_motor_gain'"},
      {3, "torque_motor_gain", "flapper_stiffness",
       "t.csv:7: column 'name': row 3 is 'torque_motor_gain', not 'flapper_stiffness'; write id 4 or name "
       "'torque_motor_gain'"},
      {3, "first_stage", "second_stage",
       "t.csv:7: column 'group': 'torque_motor_gain' belongs to group 'first_stage', not 'second_stage'; write "
       "'first_stage'"},
      {3, "100,5,200", "300,5,200",
       "t.csv:7: column 'nominal': 'torque_motor_gain' nominal (300 N/A) is outside its bounds (5 N/A to 200 N/A); "
       "move it inside or widen 'upper'"},
      {3, "100,5,200", "100,0,200",
       "t.csv:7: column 'lower': 'torque_motor_gain' has scale log10 but its lower bound is 0 N/A; write a positive "
       "lower bound or scale lin"},
      {3, "100,5,200", "x,5,200",
       "t.csv:7: column 'nominal': 'x' is not a finite number; write a number with a decimal point, like 1.4e9"},
      {3, "100,5,200", "100,5,nan",
       "t.csv:7: column 'upper': 'nan' is not a finite number; write a number with a decimal point, like 1.4e9"},
      {3, "100,5,200", "\"100,0\",5,200",
       "t.csv:7: column 'nominal': '100,0' is not a finite number; write a number with a decimal point, like 1.4e9"},
      {3, "100,5,200", "100,100,100",
       "t.csv:7: column 'estimate': 'torque_motor_gain' is to be estimated but its bounds are equal (100 N/A); write "
       "estimate 0 or widen the bounds"},
      {3, "log10", "ln", "t.csv:7: column 'scale': unknown scale 'ln'; write lin or log10"},
      {3, "log10,1", "log10,yes",
       "t.csv:7: column 'estimate': 'yes' is neither 0 nor 1; write 1 to free the row in a fit, 0 to hold it"},
      {3, "N/A", "lbf/A",
       "t.csv:7: column 'unit': unknown unit 'lbf/A' for 'torque_motor_gain'; write the values in SI and the unit "
       "'N/A'"},
      {3, "3,torque_motor_gain", "42,torque_motor_gain",
       "t.csv:7: column 'id': '42' is not a row number from 1 to 41; write 3 for 'torque_motor_gain'"},
      {3, "3,torque_motor_gain", ",torque_motor_gain",
       "t.csv:7: column 'group': a row without id belongs to an effect, but its group is 'first_stage'; write id 3 for "
       "'torque_motor_gain'"},
      {3, "3,torque_motor_gain", ",extra",
       "t.csv:7: column 'group': a row without id belongs to an effect, but its group is 'first_stage'; write "
       "effect:NAME, or give the row its id"},
      {3, "first_stage", "first_stage,first_stage",
       "t.csv:7: the row has 12 cells, the header 11; quote cells that hold a comma, and fill or remove cells"},
      {38, "700000000,2200000000", "2200000000,700000000",
       "t.csv:42: column 'upper': 'bulk_modulus' upper (7e+08 Pa) is below lower (2.2e+09 Pa); swap them or widen "
       "'upper'"},
  };
  for (const auto& c : cases) {
    const std::string what = refusal(edited(c.id, c.from, c.to)).what();
    EXPECT_EQ("t.csv" + what.substr(path().size()), c.message);
  }
}

TEST_F(TableFile, DuplicateAndMissingRowsAreRefused) {
  const std::string text = text_of(borello);
  const auto row_3 = text.substr(text.find("\n3,") + 1, text.find("\n4,") - text.find("\n3,"));
  auto e = refusal(written(text + row_3));
  EXPECT_EQ(e.where.line, line_of(42));
  EXPECT_EQ(e.rule, "row 3 'torque_motor_gain' is here and on line 7");

  std::string without = text;
  without.erase(without.find(row_3), row_3.size());
  e = refusal(written(without));
  EXPECT_NE(e.rule.find("3 'torque_motor_gain'"), std::string::npos);
}

TEST_F(TableFile, HeaderMustBeTheContracts) {
  EXPECT_EQ(refusal(written("id,name,group\n")).rule, "the column is missing");
  EXPECT_EQ(refusal(written("id,name,group,colour\n")).rule, "unknown column");
  EXPECT_EQ(refusal(written("id,name,id\n")).rule, "the column appears twice");
  EXPECT_EQ(refusal(written("")).rule, "the file has no header row");
  EXPECT_EQ(refusal(written("id,\"name")).rule, "a quoted cell is not closed");
  const std::string large = written("id,name\n");
  std::filesystem::resize_file(large, largest_table + 1);
  EXPECT_EQ(refusal(large).rule, "has more than 16 MB, the most that such a file may");
  EXPECT_EQ(refusal(path("absent.csv")).rule, "cannot be read: No such file or directory");
}

TEST_F(TableFile, RowsOfEffectsAreKeptAfterThe41) {
  const std::string text = text_of(borello);
  const std::string effect = ",delay,effect:transport_delay,0,0,0.01,lin,1,s,delay of the command,fitted\n";
  const Table table = read_table(written(text + effect));
  ASSERT_EQ(table.rows.size(), 42u);
  EXPECT_EQ(table[41].id, 0);
  EXPECT_EQ(table[41].group, "effect:transport_delay");
  EXPECT_EQ(refusal(written(text + effect + effect)).where.column, "name");
  EXPECT_EQ(refusal(written(text + ",nozzle_gap,effect:x,0,0,1,lin,1,m,,\n")).where.column, "name");
}

TEST(UnitCube, MapsBoundsToZeroAndOneAndBack) {
  for (const Row& row : read_table(borello).rows) {
    EXPECT_EQ(coordinate(row).to_unit(row.lower), 0) << row.name;
    EXPECT_NEAR(coordinate(row).to_unit(row.upper), 1, 1e-15) << row.name;
    EXPECT_EQ(coordinate(row).from_unit(0), row.lower) << row.name;
    EXPECT_NEAR(coordinate(row).from_unit(1), row.upper, 1e-15 * row.upper) << row.name;
    EXPECT_NEAR(coordinate(row).from_unit(coordinate(row).to_unit(row.nominal)), row.nominal, 1e-14 * row.upper)
        << row.name;
  }
}

// A fit that ends at a bound writes it into its table, which is refused beyond it: powers round.
TEST(Coordinate, NoUnitValueLiesBeyondTheBounds) {
  for (int k = 1; k < 2000; ++k) {
    const double lower = 1e-3 * k, upper = lower * (1.5 + 0.37 * k);
    for (const bool log_scale : {false, true}) {
      const Coordinate c{"x", "-", lower, upper, log_scale, lower};
      EXPECT_GE(c.from_unit(0), lower) << k;
      EXPECT_LE(c.from_unit(1), upper) << k;
    }
  }
}

}  // namespace
}  // namespace servodx
