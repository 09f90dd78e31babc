// The header of a log is found where a recorder put it, and told where there is none.
#include "signals/header.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "base/csv.h"
#include "base/error.h"

namespace servodx {
namespace {

TEST(Header, ARowOfUnitsBelowTheHeaderIsNoRowOfSamples) {
  const auto units_below = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    return csv.next_row() ? units_row(csv) : std::vector<std::string>{};
  };
  EXPECT_EQ(units_below("t;p_A;x\n[s];(psi);mm\n0;1,5;2\n"), (std::vector<std::string>{"s", "psi", "mm"}));
  EXPECT_EQ(units_below("t,id\n\"s\",\n0,1\n"), (std::vector<std::string>{"s", ""}));
  EXPECT_TRUE(units_below("t;x\n0;1,5\n").empty());
  EXPECT_TRUE(units_below("t,x\nstart,stop\n").empty());  // words, and none a unit
}

TEST(Header, LinesOfARecorderAboveTheHeaderArePassed) {
  const auto header_below = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    const long above = pass_lines_above_header(csv, "log.csv");
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

TEST(Header, OfLabViewsBlocksIsBelowThem) {
  const std::string text =
      "LabVIEW Measurement\nDecimal_Separator\t,\nTime\t10:11:12.123\n***End_of_Header***\n\nChannels\t2\n"
      "Samples\t3\t3\n***End_of_Header***\nX_Value\tStrom [mA]\tWeg "
      "[mm]\tComment\n0,0\t0,02\t-0,17\n0,001\t0,02\t-0,16\n";
  CsvCursor csv(text, "log.lvm");
  EXPECT_EQ(pass_lines_above_header(csv, "log.lvm"), 7);
  EXPECT_EQ(csv.header(), (std::vector<std::string>{"X_Value", "Strom [mA]", "Weg [mm]", "Comment"}));
  EXPECT_EQ(csv.header_line(), 9);
  EXPECT_EQ(csv.separator(), '\t');
  EXPECT_TRUE(ends_with_comment(csv.header()));
}

// Some lines above the names, and not beside them: one for each column but the time and the comment.
TEST(Header, LabViewsUnitsStandInARowOfTheirOwn) {
  const auto units_of = [](const std::string& label) {
    const std::string text = "LabVIEW Measurement\n" + label + "X0\t0\t0\n***End_of_Header***\n" +
                             "X_Value\tVentilstrom\tHub\tComment\n0,0\t0,02\t-0,17\n0,001\t0,02\t-0,16\n";
    CsvCursor csv(text, "log.lvm");
    pass_lines_above_header(csv, "log.lvm");
    return units_above(text, csv);
  };
  EXPECT_EQ(units_of("Y_Unit_Label\tmA\tmm\n"), (std::vector<std::string>{"s", "mA", "mm", ""}));
  EXPECT_TRUE(units_of("Y_Unit_Label\tmA\n").empty());
  EXPECT_TRUE(units_of("").empty());
}

std::string refusal(const std::string& text) {
  try {
    CsvCursor csv(text, "log.csv");
    pass_lines_above_header(csv, "log.csv");
    require_names(csv, "log.csv");
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Header, ThatIsNumbersIsNone) {
  EXPECT_EQ(refusal("0,0.02,1\n1,0.02,1\n"),
            "log.csv:1: there is no header row: the first row is numbers; write a row of 'name [unit]' above it");
  EXPECT_EQ(refusal("a,1,2\n1,0.02,1\n"), "accepted");
}

TEST(Header, OfPairsOfTimeAndValueIsRefused) {
  const std::string said = refusal(
      "Name\tServo.sv2\n\nName\tMAIN.fCmd\tName\tMAIN.fPos\nSampleTime[ms]\t1\tSampleTime[ms]\t1\n"
      "0.0\t0.02\t0.0\t-0.16\n1.0\t0.02\t1.0\t-0.15\n");
  EXPECT_TRUE(said.starts_with("log.csv:5: its columns go in pairs")) << said;
  EXPECT_NE(said.find("; export with one time column"), std::string::npos) << said;
}

TEST(Header, BelowAQuotedLineThatIsNoneIsFound) {
  const std::string text = "run\n\"a\" b, c\nt,x,y\n0,1,2\n";
  CsvCursor csv(text, "log.csv");
  EXPECT_EQ(pass_lines_above_header(csv, "log.csv"), 2);
  EXPECT_EQ(csv.header().front(), "t");
}

}  // namespace
}  // namespace servodx
