// A user's header cells are taken for the signals that a person would take them for, and for none where they would not.
#include "signals/guess.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "servodx/log.h"

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

TEST(Guess, ASetpointInTheUnitOfACurrentIsTheCommand) {
  EXPECT_EQ(taken({"Consigna [mA]"}), "command in mA");
  EXPECT_EQ(taken({"Sollwert [mA]"}), "command in mA");
  EXPECT_EQ(taken({"Sollwert [mm]"}), "setpoint in mm");
  EXPECT_EQ(taken({"Sollwert"}), "setpoint");
  EXPECT_TRUE(guess_columns({"Consigna [mA]"})[0].weak) << "taken without a question";
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

TEST(Guess, UnitsOfARowBelowAreTheColumns) {
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
  EXPECT_EQ(taken(header, 3), "control_flow");  // a stream of oil, no current
}

TEST(Guess, NamesInItalianFrenchAndChinese) {
  EXPECT_EQ(taken({"tempo [s]"}), "time in s");
  EXPECT_EQ(taken({"posizione cassetto [mm]"}), "spool_position in mm");
  EXPECT_EQ(taken({"posizione pistone [mm]"}), "piston_position in mm");
  EXPECT_EQ(taken({"pressione B [bar]"}), "pressure_b in bar");
  EXPECT_EQ(taken({"pressione alimentazione [bar]"}), "supply_pressure in bar");
  EXPECT_EQ(taken({"temperatura olio [\xC2\xB0"
                   "C]"}),
            "oil_temperature in \xC2\xB0"
            "C");
  EXPECT_EQ(taken({"courant (mA)"}), "command in mA");
  EXPECT_EQ(taken({"\xE6\x97\xB6\xE9\x97\xB4(s)"}), "time in s");
  EXPECT_EQ(taken({"\xE6\x8C\x87\xE4\xBB\xA4\xE7\x94\xB5\xE6\xB5\x81\xEF\xBC\x88mA\xEF\xBC\x89"}), "command in mA");
  EXPECT_EQ(taken({"A\xE8\x85\x94\xE5\x8E\x8B\xE5\x8A\x9B(MPa)"}), "pressure_a in MPa");
  EXPECT_EQ(taken({"\xE4\xBE\x9B\xE6\xB2\xB9\xE5\x8E\x8B\xE5\x8A\x9B(MPa)"}), "supply_pressure in MPa");
}

TEST(Guess, TheUnitDecidesBetweenSetpointAndCommand) {
  const std::vector<std::string> header = {"command [mm]", "current [mA]", "Soll [mm]",
                                           "Stellgr\xC3\xB6\xC3\x9F"
                                           "e [mA]"};
  EXPECT_EQ(taken(header, 0), "setpoint in mm");
  EXPECT_EQ(taken(header, 1), "command in mA");
  EXPECT_FALSE(guess_columns(header)[0].canonical);
  EXPECT_EQ(taken({header[2], header[3]}, 0), "setpoint in mm");
  EXPECT_EQ(taken({header[2], header[3]}, 1), "command in mA");
}

TEST(Guess, AUnitBeyondTheTableIsCalledUnknown) {
  for (const char* unit : {"kp/cm2", "at", "mbar", "bara", "bar abs", "bar(a)", "furlong"}) {
    const ColumnGuess g = guess_columns({fmt::format("pA [{}]", unit)})[0];
    EXPECT_EQ(g.signal, Signal::pressure_a) << unit;
    EXPECT_NE(g.question.find(fmt::format("unknown unit '{}'", unit)), std::string::npos) << g.question;
    EXPECT_FALSE(g.unit_in_brackets) << unit;
  }
  EXPECT_EQ(guess_columns({"pA [kp/cm2]"})[0].gain, "0.980665");
  EXPECT_EQ(guess_columns({"pA [daN/cm2]"})[0].gain, "");
  EXPECT_EQ(guess_columns({"Time [ns]"})[0].gain, "0.001");
  EXPECT_EQ(guess_columns({"Time [100 ns]"})[0].gain, "0.1");
  EXPECT_EQ(guess_columns({"spool [mils]"})[0].gain, "0.001");
  EXPECT_EQ(guess_columns({"pA (bara)"})[0].offset, "-1.013 bar");
  EXPECT_EQ(taken({"pA [N/mm2]"}), "pressure_a in MPa");  // another name of one
  EXPECT_EQ(taken({"spool [micron]"}), "spool_position in um");
}

TEST(Guess, AUnitOfNoSignalGivesNone) {
  for (const char* cell : {"Spool velocity [m/s]", "Pump speed [rpm]", "Piston (mm/s)", "Piston mm/s", "Kolben/mm/s"})
    EXPECT_FALSE(guess_columns({cell})[0].signal) << cell;
}

TEST(Guess, ARatioIsAUnitAsAWhole) {
  for (const char* cell : {"Leckage ml/min", "Leckage_cc/min", "Leckage [ml/min]"}) {
    const ColumnGuess g = guess_columns({cell})[0];
    EXPECT_EQ(g.name, "Leckage") << cell;
    EXPECT_EQ(g.signal, Signal::leakage_flow) << cell;
    EXPECT_EQ(g.unit, "l/min") << cell;
    EXPECT_EQ(g.gain, "0.001") << cell;
    EXPECT_FALSE(g.question.empty()) << cell;
  }
}

TEST(Guess, CapitalsBehindAWordAreAUnit) {
  EXPECT_EQ(taken({"TankPSI"}), "return_pressure in psi");
  EXPECT_EQ(taken({"OilF"}), "oil_temperature in degF");
  EXPECT_EQ(taken({"OilC"}), "oil_temperature in degC");
  for (const char* other : {"PressA", "PressB", "ValveIN", "PSI"})
    EXPECT_EQ(guess_columns({other})[0].unit, "") << other;
}

TEST(Guess, APerCentOfACurrentIsOfItsRatedOne) {
  for (const char* cell : {"Drive (% rated)", "command (%)", "command (pct)", "current (percent)"})
    EXPECT_EQ(guess_columns({cell})[0].unit, "% of rated") << cell;
}

TEST(Guess, ANameThatSaysLittleIsWeak) {
  for (const char* name :
       {"P1 (bar)", "Cyl 1 Press (psi)", "p_head [bar]", "x [mm]", "Weg [mm]", "Displacement [mm]"}) {
    const ColumnGuess g = guess_columns({name})[0];
    EXPECT_TRUE(g.signal && g.weak) << name;
  }
  EXPECT_FALSE(guess_columns({"pA (bar)"})[0].weak);
}

// A control error, a motor's current and the room are recorded beside the valve; its torque motor is its own.
TEST(Guess, WhatIsMeasuredBesideTheValveIsNoSignalOfIt) {
  for (const char* cell : {"Position error [mm]", "Motor current [A]", "Pump flow [l/min]",
                           "Ambient temperature [degC]", "Load cylinder position [mm]", "Stroke RMS [mm]"})
    EXPECT_FALSE(guess_columns({cell})[0].signal) << cell;
  EXPECT_EQ(taken({"Torque motor current [mA]"}), "command in mA");
  const std::vector<std::string> header = {"Position error [mm]", "Position actual [mm]"};
  EXPECT_EQ(taken(header, 1), "piston_position in mm");
}

TEST(Guess, OfTwoColumnsThatSayAsMuchOneIsAsked) {
  const auto guesses = guess_columns({"Cyl1 pos [mm]", "Cyl2 pos [mm]", "pA [bar]"});
  EXPECT_NE(guesses[0].question.find("'Cyl1 pos' or 'Cyl2 pos'"), std::string::npos) << guesses[0].question;
  EXPECT_TRUE(guesses[2].question.empty()) << guesses[2].question;
  const auto twice = guess_columns({"PA [bar]", "PA [psi]"});
  EXPECT_EQ(twice[0].question, "is it 'PA' in bar or 'PA' in psi that is the pressure_a?");
  // A name that says more decides by itself.
  EXPECT_TRUE(guess_columns({"Pressure A [bar]", "Pressure A raw [bar]"})[0].question.empty());
}

TEST(Guess, OfTwoPortsIsThePressureOfNeither) {
  for (const char* cell : {"Pressure A-B [bar]", "P A - P B [bar]", "PA-PB [bar]", "pA - pB [bar]", "p_A-p_T [bar]",
                           "Pressure A minus B [bar]", "Pressure P-T [bar]", "Pressure difference [bar]"})
    EXPECT_EQ(taken({cell}), "nothing in bar") << cell;
  EXPECT_EQ(taken({"T_A [degC]"}), "oil_temperature in degC");
}

TEST(Guess, ATemperatureByItsUnitAloneIsAsked) {
  EXPECT_TRUE(guess_columns({"Fluid 3 (C)"})[0].weak);
  EXPECT_FALSE(guess_columns({"T oil (C)"})[0].weak);
}

TEST(Guess, LettersWithoutTheirAccentsAndInOtherAlphabets) {
  EXPECT_EQ(taken({"Presi\xC3\xB3n A [bar]"}), "pressure_a in bar");
  EXPECT_EQ(taken({"T\xC5\x82oczysko [mm]"}), "piston_position in mm");
  EXPECT_EQ(taken({"\xD0\x97\xD0\xBE\xD0\xBB\xD0\xBE\xD1\x82\xD0\xBD\xD0\xB8\xD0\xBA, "
                   "\xD0\xBC\xD0\xBC"}),  // "spool, mm" in Cyrillic, its first letter a capital
            "spool_position in mm");
}

TEST(Guess, WhatItDoesNotKnowIsNothing) {
  EXPECT_EQ(taken({"note"}), "nothing");
  EXPECT_EQ(taken({"operator id"}), "nothing");
}

}  // namespace
}  // namespace servodx
