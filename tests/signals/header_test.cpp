// The header of a log is found where a recorder put it, and told where there is none.
#include "signals/header.h"

#include <gtest/gtest.h>

#include <string>
#include <tuple>
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
  EXPECT_EQ(header_below("a;b;c\nd\ne;f;g\n0;1,5;\n"), std::pair(0L, std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(header_below("t;p_A;x\n0;1,5;2\n"), std::pair(0L, three));
  EXPECT_EQ(header_below("t;p_A;x\n0;1,5\n"), std::pair(0L, three));  // ragged, and refused as such
  EXPECT_EQ(header_below("t;p_A;x\nwords\n"), std::pair(0L, three));
}

// Channels of a recorder, and lines above that are padded to the width of the rows.
TEST(Header, OfRowsAsWideIsTheOneWithTheMostNames) {
  const auto header_line = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    pass_lines_above_header(csv, "log.csv");
    return csv.header_line();
  };
  EXPECT_EQ(header_line("a;b;c\nd\nt;p_A;x\n0;1,5;\n"), 3);
  EXPECT_EQ(header_line("Recorder;;\nrate;1000;\nt;p_A;spool\nms;bar;mm\nclock;CH 1;CH 2\n0;1,5;2\n"), 3);
  EXPECT_EQ(header_line("run 7\nt;p_A;spool\nms;bar;mm\nclock;CH 1;CH 2\n0;1,5;2\n"), 2);
  EXPECT_EQ(header_line("t;valve;valve\n;current;spool\n0;1,5;2\n"), 1);  // a column without a name is none
}

TEST(Header, RowsOfTextBelowItArePassed) {
  const auto below = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    const RowsBelow rows = pass_rows_below_header(csv, "log.csv");
    return std::pair(rows.passed, rows.units);
  };
  const std::vector<std::string> units = {"ms", "bar", "mm"}, none;
  EXPECT_EQ(below("t;p_A;x\n0;1,5;2\n"), std::pair(0L, none));
  EXPECT_EQ(below("t;p_A;x\nms;bar;mm\nclock;CH 1;CH 2\n0;1,5;2\n"), std::pair(2L, units));
  EXPECT_EQ(below("t;p_A;x\nclock;CH 1;CH 2\nms;bar;mm\n0;1,5;2\n"), std::pair(2L, units));
  EXPECT_EQ(below("t;p_A;x\nUnit;bar;mm\nOffset;0;0\nScaleFactor;1;1,0\n0;1,5;2\n"),
            std::pair(3L, std::vector<std::string>{"", "bar", "mm"}));
  EXPECT_EQ(below("t;p_A;x\nnan;1;2\n0;1,5;2\n"), std::pair(0L, none));          // a sample without its time
  EXPECT_EQ(below("t;p_A;x\nabc;1;2\n0;1,5;2\n"), std::pair(0L, none));          // to be refused
  EXPECT_EQ(below("t;p_A;x\nabc;def;ghi\njkl;mno;pqr\n"), std::pair(0L, none));  // no numbers at all
  EXPECT_EQ(below("t;p_A;x\nclock;CH 1\n0;1,5;2\n"), std::pair(0L, none));       // narrower: to be refused
  EXPECT_THROW(below("t;p_A;x\nScaleFactor;1;0,5\n0;1,5;2\n"), InputError);      // it changes the numbers
  EXPECT_THROW(below("t;p_A;x\nOffset;1;1\n0;1,5;2\n"), InputError);
}

TEST(Header, BehindAHashRightAboveTheNumbersIsOne) {
  const auto header_of = [](const std::string& text) {
    CsvCursor csv(text, "log.csv");
    pass_lines_above_header(csv, "log.csv");
    double first = -1;
    if (csv.next_row()) csv.next_number(first);
    return std::tuple(csv.header(), csv.header_line(), first, csv.line());
  };
  const std::vector<std::string> three = {"t", "p_A", "x"};
  EXPECT_EQ(header_of("# note\n# t,p_A,x\n5,1.5,2\n"), std::tuple(three, 2, 5.0, 3));
  EXPECT_EQ(header_of("#t;p_A;x\n5,5;1,5;2,5\n"), std::tuple(three, 1, 5.5, 2));
  EXPECT_EQ(header_of("# t,p_A\nt,p_A,x\n5,1.5,2\n"), std::tuple(three, 2, 5.0, 3));
  EXPECT_EQ(header_of("# a,b,c\nt,p_A,x\n5,1.5,2\n"), std::tuple(three, 2, 5.0, 3));
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
  EXPECT_EQ(refusal("# two,names\n0,0.02,1\n1,0.02,1\n"),
            "log.csv:2: there is no header row: the first row is numbers; write a row of 'name [unit]' above it");
}

TEST(Header, OfPairsOfTimeAndValueIsRefused) {
  const std::string said = refusal(
      "Name\tServo.sv2\n\nName\tMAIN.fCmd\tName\tMAIN.fPos\nSampleTime[ms]\t1\tSampleTime[ms]\t1\n"
      "0.0\t0.02\t0.0\t-0.16\n1.0\t0.02\t1.0\t-0.15\n");
  EXPECT_TRUE(said.starts_with("log.csv:5: its columns go in pairs")) << said;
  EXPECT_NE(said.find("; export with one time column"), std::string::npos) << said;
  for (const std::string header : {"Name\trCur\tName\trPos", "X_Value\tA\tX_Value\tB\tComment"}) {
    const std::string right_above = refusal(header + "\n0.0\t0.02\t0.0\t-0.16\n1.0\t0.02\t1.0\t-0.15\n");
    EXPECT_TRUE(right_above.starts_with("log.csv:2: its columns go in pairs")) << header << ": " << right_above;
  }
}

TEST(Header, OfNamesWithALetterThatIsAUnitIsNoRowOfUnits) {
  CsvCursor csv("a;b;c;d;e;f\nZeit;Strom;Weg;Weg;A;B\n0;1;2;3;4;5\n", "log.csv");
  ASSERT_TRUE(csv.next_row());
  EXPECT_TRUE(units_row(csv).empty());
  const std::string text = "a;b;c;d\ns;mA;rpm;kp/cm2\n0;1;2;3\n";
  CsvCursor with_others(std::string_view(text), "log.csv");
  ASSERT_TRUE(with_others.next_row());
  EXPECT_EQ(units_row(with_others).size(), 4);
}

TEST(Header, BehindAUnitOfTimeTwoOtherUnitsAreARowOfUnits) {
  const auto units_below = [](const std::string& row) {
    const std::string text = "time;command;spool_position;n;on;mode\n" + row + "\n0;1;2;3;1;7\n";
    CsvCursor csv(std::string_view(text), "log.csv");
    return pass_rows_below_header(csv, "log.csv").units;
  };
  EXPECT_EQ(units_below("s;mA;mm;inc;bool;digits"),
            (std::vector<std::string>{"s", "mA", "mm", "inc", "bool", "digits"}));
  EXPECT_EQ(units_below("[ms];[mA];[mm];inc;bool;digits").size(), 6u);
  EXPECT_TRUE(units_below("s;mA;on;inc;bool;digits").empty());
  EXPECT_TRUE(units_below("clock;mA;mm;bar;bool;digits").empty());
}

// Wider than what is judged of a row.
TEST(Header, NamesOverManyColumnsTakeTheirGroups) {
  std::string groups = ";Ventil;;Kolben", names = "Zeit [s];Strom [mA];Weg [mm];Weg [mm]", numbers = "0;1;2;3";
  for (int k = 5; k <= 24; ++k) groups += ";", names += ";K" + std::to_string(k), numbers += ";0,5";
  const std::string text = groups + "\n" + names + "\n" + numbers + "\n";
  CsvCursor csv(std::string_view(text), "log.csv");
  EXPECT_EQ(pass_lines_above_header(csv, "log.csv"), 1);
  ASSERT_EQ(csv.header().size(), 24u);
  EXPECT_EQ(csv.header()[2], "Ventil Weg [mm]");
  EXPECT_EQ(csv.header()[3], "Kolben Weg [mm]");
  EXPECT_EQ(csv.header()[23], "K24");
}

TEST(Header, NamesOverSeveralColumnsTakeTheirGroups) {
  const auto names = [](const std::string& text) {
    CsvCursor csv(std::string_view(text), "log.csv");
    pass_lines_above_header(csv, "log.csv");
    return csv.header();
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(
      names(";Ventil;;Kolben;Druecke;\nZeit [s];Strom [mA];Weg [mm];Weg [mm];A [bar];B [bar]\n0;1;2;3;4;5\n"),
      (Names{"Zeit [s]", "Strom [mA]", "Ventil Weg [mm]", "Kolben Weg [mm]", "Druecke A [bar]", "Druecke B [bar]"}));
  EXPECT_EQ(names(",Valve,,Cylinder,Pressures,\nTime,Current,Position,Position,A,B\ns,mA,mm,mm,bar,bar\n0,1,2,3,4,5\n"),
            (Names{"Time", "Current", "Valve Position", "Cylinder Position", "Pressures A", "Pressures B"}));
  EXPECT_EQ(names("a;b;c;d\ntime;command;x;y\n0;1;2;3\n"), (Names{"time", "command", "x", "y"}));  // none repeats
  EXPECT_EQ(names("run;;;\ntime;command;x;x\n0;1;2;3\n"), (Names{"time", "command", "x", "x"}));   // tells none apart
}

TEST(Header, ARowOfChannelNumbersBelowItIsNoSample) {
  const auto begins = [](const std::string& rows) {
    const std::string text = "t;i;x;p\n" + rows;
    CsvCursor csv(std::string_view(text), "log.csv");
    EXPECT_TRUE(csv.next_row());
    return begins_with_channel_numbers(csv, 0, "log.csv");
  };
  EXPECT_TRUE(begins("0;1;2;3\n0,1;0,3;0,1;104\n0,2;0,3;0,1;104,1\n"));
  EXPECT_TRUE(begins("0;0;0;0\n0,1;9;0,1;104\n0,2;9,1;0,1;104,1\n"));
  EXPECT_FALSE(begins("0;0;0;0\n0,1;0;0,1;0,2\n0,2;0,1;0,2;0,3\n"));  // begins at rest
  EXPECT_FALSE(begins("0;0;0;104\n0,1;9;0,1;104\n0,2;9;0,1;104\n"));
  EXPECT_THROW(begins("0;1;2;3\n0;0,3;0,1;104\n0,2;0,3;0,1;104,1\n"), InputError);
}

TEST(Header, BelowAQuotedLineThatIsNoneIsFound) {
  const std::string text = "run\n\"a\" b, c\nt,x,y\n0,1,2\n";
  CsvCursor csv(text, "log.csv");
  EXPECT_EQ(pass_lines_above_header(csv, "log.csv"), 2);
  EXPECT_EQ(csv.header().front(), "t");
}

}  // namespace
}  // namespace servodx
