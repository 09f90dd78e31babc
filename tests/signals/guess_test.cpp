// A user's header cells are taken for the signals that a person would take them for, and for none where they would not.
#include "signals/guess.h"

#include <gtest/gtest.h>

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

TEST(Guess, WhatItDoesNotKnowIsNothing) {
  EXPECT_EQ(taken({"note"}), "nothing");
  EXPECT_EQ(taken({"operator id"}), "nothing");
}

}  // namespace
}  // namespace servodx
