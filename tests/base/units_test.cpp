#include "base/units.h"

#include <gtest/gtest.h>

#include <set>

#include "servodx/error.h"

namespace servodx {
namespace {

std::string refusal(std::string_view text, Dimension dimension) {
  try {
    parse_quantity(text, dimension, {"rig.toml", 5, "valve.rated_current"});
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Units, EachNameIsListedOnce) {
  std::set<std::string_view> names;
  for (const Unit& unit : unit_table()) EXPECT_TRUE(names.insert(unit.name).second) << unit.name;
}

TEST(Units, LettersBeyondAsciiSpellTheSameUnits) {
  EXPECT_EQ(find_unit("\xC2\xB0"
                      "C"),
            find_unit("degC"));
  EXPECT_EQ(find_unit("\xE2\x84\x83"), find_unit("degC"));
  EXPECT_EQ(find_unit("\xC2\xB5m"), find_unit("um"));
  EXPECT_EQ(find_unit("\xCE\xBCm"), find_unit("um"));
}

TEST(Units, EveryUnitGoesToSiAndBack) {
  for (const Unit& unit : unit_table())
    for (double x : {-40.0, 0.5, 123.456})
      EXPECT_NEAR(unit.from_si(unit.to_si(x)), x, 1e-12 * std::max(1.0, std::abs(unit.offset / unit.scale())))
          << unit.name;
}

TEST(Units, MatchTheirDefinitions) {
  const struct {
    const char* text;
    Dimension dimension;
    double si;
  } cases[] = {
      {"20 mA", Dimension::current, 0.02},
      {"207 bar", Dimension::pressure, 20.7e6},
      {"3000 psi", Dimension::pressure, 3000 * 4.4482216152605 / (0.0254 * 0.0254)},
      {"1 gpm", Dimension::flow, 3.785411784e-3 / 60},
      {"14 l/min", Dimension::flow, 14e-3 / 60},
      {"1 lbf", Dimension::force, 4.4482216152605},
      {"1 in", Dimension::length, 0.0254},
      {"3.5 um", Dimension::length, 3.5e-6},
      {"20 cm3", Dimension::volume, 20e-6},
      {"7.88e-4 m2", Dimension::area, 7.88e-4},
      {"14 mm2/s", Dimension::kinematic_viscosity, 14e-6},
      {"-40 degF", Dimension::temperature, 233.15},
      {"-40 degC", Dimension::temperature, 233.15},
      {"5 %", Dimension::fraction, 0.05},
      {"0.05", Dimension::fraction, 0.05},
      {" +2.5  ms ", Dimension::time, 2.5e-3},
      {"20mA", Dimension::current, 0.02},
  };
  for (const auto& c : cases) EXPECT_DOUBLE_EQ(parse_quantity(c.text, c.dimension, {}).value, c.si) << c.text;
}

TEST(Units, ExactFactorsKeepDecimalQuantitiesExact) {
  EXPECT_EQ(parse_quantity("20 mA", Dimension::current, {}).value, 0.02);
  EXPECT_EQ(parse_quantity("35 um", Dimension::length, {}).value, 35e-6);
  EXPECT_EQ(parse_quantity("0.58 mm", Dimension::length, {}).value, 0.58e-3);
}

TEST(Units, EachRefusalSaysRuleAndMend) {
  const std::string place = "rig.toml:5: column 'valve.rated_current': ";
  EXPECT_EQ(refusal("20", Dimension::current), place + "'20' has no unit; add one of A, mA");
  EXPECT_EQ(refusal("20 ma", Dimension::current), place + "unknown unit 'ma'; use one of A, mA");
  for (const char* range : {"2..5 um", "2-5 um", "2 to 5 um", "3,5 um"})
    EXPECT_NE(
        refusal(range, Dimension::length).find("follows the number: a range, or a decimal comma; give one number"),
        std::string::npos)
        << refusal(range, Dimension::length);
  EXPECT_EQ(refusal("20 mm", Dimension::current), place + "'mm' is a unit of length, not of current; use one of A, mA");
  EXPECT_EQ(refusal("mA", Dimension::current),
            place + "'mA' is not a quantity; write a number and a unit of current (A, mA)");
  EXPECT_EQ(refusal("nan mA", Dimension::current),
            place + "'nan mA' is not a quantity; write a number and a unit of current (A, mA)");
}

TEST(Units, AQuantityThatIsInfiniteInSiIsRefused) {
  EXPECT_EQ(refusal("1e305 bar", Dimension::pressure),
            "rig.toml:5: column 'valve.rated_current': '1e305 bar' is beyond 1.8e308 in SI; write a quantity that "
            "something has");
  EXPECT_THROW(parse_gain("1e305 bar/V", Dimension::pressure, {}), InputError);
  EXPECT_THROW(parse_gain("1e-323 mm/V", Dimension::length, {}), InputError);
}

TEST(Units, AGainDividesTheSignalsUnitByVolts) {
  EXPECT_DOUBLE_EQ(parse_gain("20 mm/V", Dimension::length, {}).value, 0.02);
  EXPECT_DOUBLE_EQ(parse_gain("2 l/min/V", Dimension::flow, {}).value, 2e-3 / 60);
  EXPECT_DOUBLE_EQ(parse_gain("10 degC/V", Dimension::temperature, {}).value, 10.0);
  EXPECT_DOUBLE_EQ(parse_gain("1 bar/mV", Dimension::pressure, {}).value, 1e8);
  EXPECT_EQ(parse_gain("-1", Dimension::flow, {}).value, -1.0);
  EXPECT_EQ(parse_gain("-1", Dimension::flow, {}).numerator, nullptr);
  for (const char* bad : {"", "mm/V", "20 mm", "20 mA/V", "20 mm/furlong", "0"})
    EXPECT_THROW(parse_gain(bad, Dimension::length, {}), InputError) << bad;
}

}  // namespace
}  // namespace servodx
