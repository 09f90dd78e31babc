// Nothing absurd is taken for a signal without a question; what the values settle is settled.
#include "signals/column_questions.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "servodx/log.h"
#include "signals/guess.h"
#include "signals/signal.h"

namespace servodx {
namespace {

struct Given {
  std::string cell;
  double low, high;
};

// A ramp from the lowest to the highest value in each column.
std::vector<ColumnGuess> asked(const std::vector<Given>& given, int rows = 11) {
  std::vector<std::string> header;
  std::vector<ColumnNumbers> numbers;
  for (const auto& [cell, low, high] : given) {
    header.push_back(cell);
    NumbersCollector collector;
    for (int k = 0; k < rows; ++k) collector.take(low + (high - low) * k / (rows - 1));
    numbers.push_back(collector.numbers());
  }
  std::vector<ColumnGuess> guesses = guess_columns(header);
  ask_by_numbers(guesses, numbers);
  return guesses;
}

std::string question(const Given& given) { return asked({given})[0].question; }

TEST(ColumnQuestions, AbsurdValuesAreAsked) {
  EXPECT_NE(question({"current [A]", -2000, 2114}).find("hardly possible as command in A"), std::string::npos);
  EXPECT_NE(question({"temp [K]", 0, 12429}).find("hardly possible as oil_temperature in K"), std::string::npos);
  EXPECT_NE(question({"pS [Pa]", 200, 207}).find("hardly possible as supply_pressure in Pa: bar"), std::string::npos);
  EXPECT_NE(question({"piston [mm]", -0.04, 0.04}).find("hardly possible as piston_position in mm"), std::string::npos);
  for (const Given& good : {Given{"current [mA]", -50, 50},
                            {"temp [degC]", 20, 60},
                            {"pS [bar]", 200, 207},
                            {"piston [mm]", -40, 40},
                            {"spool [mm]", -0.6, 0.6},
                            {"time [s]", 0, 0.01},
                            {"pT [bar]", -0.1, 13},
                            {"current [mA]", 0, 0}})
    EXPECT_EQ(question(good), "") << good.cell;
}

TEST(ColumnQuestions, ATankIsOfPressureOrOfTemperatureByUnitAndRangeAndAsked) {
  const auto tank = [](const std::string& cell, double low, double high) { return asked({{cell, low, high}})[0]; };
  EXPECT_EQ(tank("T Tank [degC]", 44, 46).signal, Signal::oil_temperature);
  EXPECT_EQ(tank("T Tank [bar]", 2, 3).signal, Signal::return_pressure);
  const ColumnGuess warm = tank("T Tank", 44, 46), low = tank("T Tank", 2, 3);
  EXPECT_EQ(warm.signal, Signal::oil_temperature);
  EXPECT_EQ(warm.unit, "degC");
  EXPECT_EQ(low.signal, Signal::return_pressure);
  for (const ColumnGuess& g : {warm, low})
    EXPECT_NE(g.question.find("the name means either"), std::string::npos) << g.question;
}

TEST(ColumnQuestions, ACurrentWithoutASignIsAsked) {
  EXPECT_NE(question({"current [mA]", 0, 50}).find("never negative"), std::string::npos);
  EXPECT_NE(question({"current [mA]", 4, 20}).find("transmitter"), std::string::npos);
  EXPECT_NE(question({"command [mA]", 0, 50}).find("never negative"), std::string::npos);
}

TEST(ColumnQuestions, APistonMeasuredFromAnEndIsAskedForItsOffset) {
  const ColumnGuess g = asked({{"piston [mm]", 105, 193}})[0];
  EXPECT_NE(g.question.find("half the stroke"), std::string::npos);
  EXPECT_TRUE(g.offset_is_open);  // where the log reaches says nothing of the stroke's middle
  EXPECT_EQ(g.offset, "");
  EXPECT_NE(question({"piston_position [mm]", 105, 193}), "");
  EXPECT_EQ(question({"piston_position [mm]", 0, 40}), "");  // its name says from where
  EXPECT_NE(question({"piston [mm]", 0, 40}), "");
  EXPECT_EQ(question({"piston [mm]", 0, 4}), "");  // a small move from the middle
}

TEST(ColumnQuestions, AUnitIsTakenByTheValuesOnlyWhereTheyAgreeWithSiAlone) {
  const ColumnGuess pascal = asked({{"pA", 2e6, 1.4e7}})[0];
  EXPECT_EQ(pascal.unit, "Pa");
  EXPECT_TRUE(pascal.by_numbers && pascal.question.empty());
  const ColumnGuess psi = asked({{"PS", 1900, 2026}})[0];
  EXPECT_NE(psi.question.find("psi or kPa"), std::string::npos) << psi.question;
  EXPECT_NE(question({"current", 0, 50}), "");
  EXPECT_NE(question({"temp", 12000, 12429}), "");
  EXPECT_EQ(asked({{"Time", 0, 0.01}})[0].unit, "s");
  EXPECT_EQ(asked({{"Time", 0, 5}})[0].unit, "ms");
  EXPECT_NE(question({"Time", 0, 10}).find("counts rows"), std::string::npos);
}

// Ticks of 100 ns since 1601 or the year 1, and what Unix counts, at 1 kHz.
TEST(ColumnQuestions, AClockThatCountsFromADateIsKnownByItsSize) {
  const struct {
    double from, step;
    const char *unit, *gain;
  } clocks[] = {{132590000000000000, 10000, "us", "0.1"},
                {637500000000000000, 10000, "us", "0.1"},
                {1.614e18, 1e6, "us", "0.001"},
                {1.614e15, 1e3, "us", ""},
                {1.614e12, 1, "ms", ""},
                {1.614e9, 1e-3, "s", ""}};
  for (const auto& clock : clocks) {
    const ColumnGuess g = asked({{"Time", clock.from, clock.from + 10 * clock.step}})[0];
    EXPECT_TRUE(g.by_numbers) << clock.from;
    EXPECT_EQ(g.question, "") << clock.from;
    EXPECT_EQ(g.unit, clock.unit) << clock.from;
    EXPECT_EQ(g.gain, clock.gain) << clock.from;
  }
  const ColumnGuess micro = asked({{"Time [us]", 132590000000000000, 132590000000100000}})[0];
  EXPECT_NE(micro.question.find("is it ticks of 100 ns since 1601?"), std::string::npos) << micro.question;
  EXPECT_EQ(micro.gain, "0.1");
  EXPECT_EQ(asked({{"Time [s]", 132590000000000000, 132590000000100000}})[0].gain, "1e-07");
  EXPECT_EQ(question({"Time [us]", 1.614e15, 1.614e15 + 1e4}), "");
}

TEST(ColumnQuestions, MicrosecondsOrTicksWithoutADateAreAsked) {
  for (const Given& either : {Given{"Time", 0, 1e5}, Given{"Time", 5e6, 5e6 + 1e4}, Given{"Ticks", 0, 1e5}})
    EXPECT_NE(question(either).find("us, or ticks of 100 ns with gain = \"0.1\""), std::string::npos) << either.cell;
  const ColumnGuess ticks = asked({{"Time", 0, 1e6}})[0];  // 100 ms at a step, in us
  EXPECT_NE(ticks.question.find("ticks of 100 ns?"), std::string::npos) << ticks.question;
  EXPECT_EQ(ticks.gain, "0.1");
  EXPECT_EQ(asked({{"Time", 0, 500}})[0].unit, "us");  // ticks of 5 us at a step
  EXPECT_EQ(question({"Time", 0, 500}), "");
}

TEST(ColumnQuestions, AColumnThatOnlyRisesMayBeTheTimeAndIsAsked) {
  const auto g = asked({{"Name", 0, 0.01}, {"spool [mm]", -0.5, 0.5}});
  EXPECT_EQ(g[0].signal, Signal::time);
  EXPECT_NE(g[0].question.find("is 'Name' the time?"), std::string::npos) << g[0].question;
  EXPECT_FALSE(asked({{"Name", 0, 10}, {"spool [mm]", -0.5, 0.5}})[0].signal);  // counts rows
  EXPECT_FALSE(asked({{"Name [mm/s]", 0, 0.01}})[0].signal);
  EXPECT_FALSE(asked({{"Name", 0, 0.01}, {"t [s]", 0, 0.01}})[0].signal);
}

TEST(ColumnQuestions, TheFirstStampsAreTheTimeWhereNoNameSaysSo) {
  const auto with_stamps = [](const std::vector<std::string>& header) {
    std::vector<ColumnGuess> guesses = guess_columns(header);
    std::vector<ColumnNumbers> numbers(header.size());
    for (std::size_t c = 0; c < 2; ++c) numbers[c].stamps = true;
    ask_by_numbers(guesses, numbers);
    return guesses;
  };
  for (const char* name : {"Datum Uhrzeit", "Data e ora", "Horodatage", "Fecha y hora"}) {
    const auto g = with_stamps({name, "Uhrzeit", "spool [mm]"});
    EXPECT_EQ(g[0].signal, Signal::time) << name;
    EXPECT_EQ(g[0].unit, "s");
    EXPECT_EQ(g[0].question, "") << g[0].question;
    EXPECT_FALSE(g[1].signal);
  }
  EXPECT_EQ(with_stamps({"Datum", "Zeit"})[1].signal, Signal::time);
}

// 12 mil are 0.3 mm, and less than the piston moves.
TEST(ColumnQuestions, AUnitBeyondTheTableCountsWithItsGain) {
  const auto g = asked({{"spool [mil]", -12, 12}, {"piston [mm]", -50, 50}});
  EXPECT_EQ(g[0].gain, "0.001");
  EXPECT_EQ(g[0].question, "unknown unit 'mil': is it 0.001 in?");
  EXPECT_EQ(g[1].question, "");
  for (const ColumnGuess& each : asked({{"spool [mil]", -12000, 12000}, {"piston [mm]", -50, 50}}))
    EXPECT_NE(each.question.find("exchanged"), std::string::npos) << each.cell;
}

TEST(ColumnQuestions, AnotherSignalInMilliamperesIsATransmittersAndAsked) {
  for (const Given& given :
       {Given{"pressure A [mA]", 6, 14}, Given{"spool [mA]", 8, 16}, Given{"piston [mA]", 5, 19}}) {
    const ColumnGuess g = asked({given})[0];
    EXPECT_TRUE(g.signal && g.gain_is_open && g.offset_is_open) << given.cell;
    EXPECT_NE(g.question.find("its range over 16 mA"), std::string::npos) << g.question;
  }
  EXPECT_NE(question({"spool [mA]", -10, 10}).find("which gain has it, in m/mA"), std::string::npos);
  EXPECT_FALSE(asked({{"pump [mA]", 0, 900}})[0].signal);  // of its motor
  EXPECT_EQ(asked({{"spool current [mA]", 6, 14}})[0].signal, Signal::command);
  EXPECT_NE(question({"pressure A", 6, 14}).find("the mA of a transmitter"), std::string::npos);
  EXPECT_EQ(question({"pressure A", 6, 140}).find("transmitter"), std::string::npos);
}

TEST(ColumnQuestions, VoltsAskForAGain) {
  const ColumnGuess g = asked({{"Valve Command (V)", -10, 10}})[0];
  EXPECT_NE(g.question.find("which gain"), std::string::npos);
  EXPECT_EQ(g.gain, "");
  EXPECT_EQ(asked({{"Pos fb [V]", 4.5, 5.5}})[0].offset, "");  // volts are from no middle
}

TEST(ColumnQuestions, NumberedPressuresAreSortedByWhatTheyDoAndAsked) {
  const auto g = asked({{"P1_bar", 128, 149}, {"P2_bar", -1, 13}, {"P3_bar", 20, 130}, {"P4_bar", 15, 120}});
  const Signal expected[] = {Signal::supply_pressure, Signal::return_pressure, Signal::pressure_a, Signal::pressure_b};
  for (std::size_t c = 0; c < 4; ++c) {
    EXPECT_EQ(g[c].signal, expected[c]) << c;
    EXPECT_NE(g[c].question, "") << c;
  }
}

TEST(ColumnQuestions, APistonThatMovesLessThanTheSpoolIsAsked) {
  for (const ColumnGuess& g : asked({{"spool [mm]", -9, 9}, {"piston [mm]", -1, 1}}))
    EXPECT_NE(g.question.find("exchanged"), std::string::npos) << g.cell;
}

}  // namespace
}  // namespace servodx
