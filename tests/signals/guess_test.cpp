// A user's header cells are taken for the signals that a person would take them for, and for none where they would not.
#include "signals/guess.h"

#include <gtest/gtest.h>

#include "base/csv.h"

namespace servodx {
namespace {

std::string taken(const std::vector<std::string>& header, std::size_t at = 0) {
  const ColumnGuess g = guess_columns(header)[at];
  return (g.signal ? std::string(info(*g.signal).name) : "nothing") + (g.unit.empty() ? "" : " in " + g.unit);
}

TEST(Guess, NamesAndUnitsAsPeopleWriteThem) {
  EXPECT_EQ(taken({"time [s]"}), "time in s");
  EXPECT_EQ(taken({"Time (ms)"}), "time in ms");
  EXPECT_EQ(taken({"Zeit (ms)"}), "time in ms");
  EXPECT_EQ(taken({"Valve cmd (mA)"}), "command in mA");
  EXPECT_EQ(taken({"LVDT (um)"}), "spool_position in um");
  EXPECT_EQ(taken({"Pos fb [V]"}), "piston_position in V");
  EXPECT_EQ(taken({"pressureA_bar"}), "pressure_a in bar");
  EXPECT_EQ(taken({"P B/psi"}), "pressure_b in psi");
  EXPECT_EQ(taken({"Supply (PSI)"}), "supply_pressure in psi");
  EXPECT_EQ(taken({"T oil (C)"}), "oil_temperature in degC");
  EXPECT_EQ(taken({"Fluid 3 (C)"}), "oil_temperature in degC");  // by its unit alone
  EXPECT_EQ(taken({"Q l/min"}), "control_flow in l/min");
  EXPECT_EQ(taken({"Press A (bar)"}), "pressure_a in bar");
  EXPECT_EQ(taken({"PressB (bar)"}), "pressure_b in bar");
  EXPECT_EQ(taken({"x_s [mm]"}), "spool_position in mm");
  EXPECT_EQ(taken({"psupply_Pa"}), "supply_pressure in Pa");
}

TEST(Guess, AUnitOfAnotherQuantityRulesASignalOut) { EXPECT_EQ(taken({"valve current [bar]"}), "nothing in bar"); }

TEST(Guess, EachSignalOnceAndTheBetterMatchWins) {
  const std::vector<std::string> header = {"Position demand (mm)", "Position (mm)", "Current demand (mA)",
                                           "Coil current (mA)"};
  EXPECT_EQ(taken(header, 0), "setpoint in mm");
  EXPECT_EQ(taken(header, 1), "piston_position in mm");
  EXPECT_EQ(taken(header, 2), "command in mA");
  EXPECT_EQ(taken(header, 3), "coil_current in mA");
}

TEST(Guess, ASubscriptIsNoUnit) {
  EXPECT_EQ(taken({"p_A"}), "pressure_a");  // no p in amperes
  EXPECT_EQ(taken({"x_s"}), "spool_position");
  EXPECT_EQ(taken({"u_in"}), "command");  // no u in inches
  EXPECT_EQ(taken({"p_A (psi)"}), "pressure_a in psi");
  EXPECT_EQ(taken({"x_{s} [mm]"}), "spool_position in mm");
  EXPECT_EQ(taken({"x_K [mm]"}), "piston_position in mm");
  EXPECT_EQ(taken({"U_cmd/V"}), "command in V");
  EXPECT_EQ(taken({"i_A"}), "command in A");
  EXPECT_EQ(taken({"t_s"}), "time in s");
  EXPECT_EQ(taken({"pT"}), "return_pressure");  // no p_P, though it has a p
  EXPECT_EQ(taken({"p_P"}), "supply_pressure");
}

TEST(Guess, UnitsInAnyCapitalsAndThePerCentOfASignal) {
  EXPECT_EQ(taken({"Time (SEC)"}), "time in s");
  EXPECT_EQ(taken({"Oil temp (DegC)"}), "oil_temperature in degC");
  EXPECT_EQ(taken({"pB (MPA)"}), "pressure_b in MPa");
  EXPECT_EQ(taken({"Valve command (%)"}), "command in % of rated");
  EXPECT_EQ(taken({"Spool [%]"}), "spool_position in % of stroke");
}

TEST(Guess, ARowOfUnitsBelowTheHeaderIsNoRowOfSamples) {
  const auto units_below = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    return csv.next_row() ? units_row(csv) : std::vector<std::string>{};
  };
  EXPECT_EQ(units_below("t;p_A;x\n[s];(psi);mm\n0;1,5;2\n"), (std::vector<std::string>{"s", "psi", "mm"}));
  EXPECT_EQ(units_below("t,id\n\"s\",\n0,1\n"), (std::vector<std::string>{"s", ""}));
  EXPECT_TRUE(units_below("t;x\n0;1,5\n").empty());
  EXPECT_TRUE(units_below("t,x\nstart,stop\n").empty());  // words, and none a unit
  const auto guesses = guess_columns({"t", "p_A", "u"}, {"s", "PSI", "V"});
  EXPECT_EQ(info(*guesses[1].signal).name, "pressure_a");
  EXPECT_EQ(guesses[1].unit, "psi");
  EXPECT_TRUE(guesses[0].unit_in_brackets);   // the reader takes it from the row
  EXPECT_FALSE(guesses[1].unit_in_brackets);  // the rig file has to say it
}

TEST(Guess, TIsATemperatureWhereTheTimeIsAnother) {
  EXPECT_EQ(taken({"t", "T"}, 1), "oil_temperature");
  EXPECT_EQ(taken({"Zeit", "T"}, 1), "oil_temperature");
  EXPECT_EQ(taken({"T"}), "time");
  EXPECT_EQ(taken({"t [s]", "T [s]"}, 1), "nothing in s");
}

TEST(Guess, UmlautsAndCompounds) {
  const std::vector<std::string> header = {"Ventilstrom Soll",
                                           "R\xC3\xBC"
                                           "cklaufdruck",
                                           "\xC3\x96ltemperatur", "Volumenstrom"};
  EXPECT_EQ(taken(header, 0), "command");
  EXPECT_EQ(taken(header, 1), "return_pressure");
  EXPECT_EQ(taken(header, 2), "oil_temperature");
  EXPECT_EQ(taken(header, 3), "nothing");  // a stream of oil, no current
}

TEST(Guess, LinesOfARecorderAboveTheHeaderArePassed) {
  const auto header_below = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    const long above = pass_lines_above_header(csv);
    return std::pair(above, csv.header());
  };
  const std::vector<std::string> three = {"t", "p_A", "x"};
  EXPECT_EQ(header_below("Run 7\nrate,1000\n\nt;p_A;x\n0;1,5;2\n"), std::pair(2L, three));
  EXPECT_EQ(header_below("# note\nRun 7\nt;p_A;x\ns;psi;mm\n0;1,5;2\n"), std::pair(1L, three));
  EXPECT_EQ(header_below("a;b;c\nd\nt;p_A;x\n0;1,5;\n"), std::pair(0L, std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(header_below("t;p_A;x\n0;1,5;2\n"), std::pair(0L, three));
  EXPECT_EQ(header_below("t;p_A;x\n0;1,5\n"), std::pair(0L, three));  // ragged, and refused as such
  EXPECT_EQ(header_below("t;p_A;x\nwords\n"), std::pair(0L, three));
}

TEST(Guess, WhatItDoesNotKnowIsNothing) {
  EXPECT_EQ(taken({"note"}), "nothing");
  EXPECT_EQ(taken({"operator id"}), "nothing");
}

}  // namespace
}  // namespace servodx
