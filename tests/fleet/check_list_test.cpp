// Lists of checks: what each row says, and where a list is refused.
#include "fleet/check_list.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

CheckList read(const std::string& text, const std::string& params = "tuned.csv") {
  const TemporaryFolder folder;
  return read_check_list(folder.write("list.csv", text), params);
}

TEST(CheckList, RowsStandInTheOrderOfTheFileWhateverTheOrderOfTheColumns) {
  const CheckList list = read(
      "# a fleet\nvalve,hours,log,note\nV7,12.5,\"a/two, of two.csv\",x\n\n# V8,1,gone.csv\nV7,0,./b.csv,\n", "t.csv");
  ASSERT_EQ(list.rows.size(), 2u);
  EXPECT_EQ(list.rows[0].log, "a/two, of two.csv");
  EXPECT_EQ(list.rows[0].valve, "V7");
  EXPECT_EQ(list.rows[0].hours, 12.5);
  EXPECT_FALSE(list.rows[0].cycles.has_value());
  EXPECT_EQ(list.rows[0].params, "t.csv");
  EXPECT_EQ(list.rows[0].line, 3);
  EXPECT_EQ(list.rows[1].log, "./b.csv");
  EXPECT_EQ(list.rows[1].line, 6);
  EXPECT_EQ(list.passed_over, std::vector<std::string>{"note"});
}

TEST(CheckList, ARowMayNameItsTableItsCyclesAndItsSerial) {
  const CheckList list = read("log;valve;hours;cycles;serial;params\na.csv;V7;1,5;1200;SN 1;v7.csv\nb.csv;V8;2;;;\n");
  EXPECT_EQ(list.rows[0].hours, 1.5);
  EXPECT_EQ(list.rows[0].cycles, 1200);
  EXPECT_EQ(list.rows[0].serial, "SN 1");
  EXPECT_EQ(list.rows[0].params, "v7.csv");
  EXPECT_FALSE(list.rows[1].cycles.has_value());
  EXPECT_EQ(list.rows[1].params, "tuned.csv");
}

TEST(CheckList, WhatIsNoListIsRefusedAtItsLineAndColumn) {
  const std::string head = "log,valve,hours,cycles\n";
  struct Case {
    std::string text;
    long line;
    std::string column;
  };
  const std::vector<Case> cases = {
      {"a.csv\nb.csv\n", 1, "log"},           {"log,valve\na.csv,V7\n", 1, "hours"},
      {"log,valve,hours,log\n", 1, "log"},    {head + "a.csv,V7,1,\n,V7,2,\n", 3, "log"},
      {head + "a.csv,,1,\n", 2, "valve"},     {head + "a.csv,V7,,\n", 2, "hours"},
      {head + "a.csv,V7,ten,\n", 2, "hours"}, {head + "a.csv,V7,-1,\n", 2, "hours"},
      {head + "a.csv,V7,nan,\n", 2, "hours"}, {head + "a.csv,V7,1,-2\n", 2, "cycles"},
      {head + "a.csv,V7,1\n", 2, ""},         {head + "a.csv,V7,1,2,3\n", 2, ""},
      {head + "# nothing\n", 0, ""},
  };
  for (const Case& c : cases) try {
      read(c.text);
      ADD_FAILURE() << c.text;
    } catch (const InputError& error) {
      EXPECT_EQ(error.where.line, c.line) << c.text;
      EXPECT_EQ(error.where.column, c.column) << c.text;
      EXPECT_FALSE(error.rule.empty() || error.mend.empty()) << c.text;
    }
  EXPECT_THROW(read_check_list("/gone.csv", "t.csv"), InputError);
}

TEST(CheckList, ARowWithoutATableIsRefusedWhereTheCallNamesNone) {
  const std::string text = "log,valve,hours,params\na.csv,V7,1,v7.csv\nb.csv,V8,1,\n";
  EXPECT_EQ(read(text).rows.size(), 2u);
  try {
    read(text, "");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(error.where.line, 3);
    EXPECT_EQ(error.where.column, "params");
  }
}

TEST(CheckList, ChecksOfOneLogStayApartByValveAndHours) {
  const CheckRow row{.log = "a.csv", .valve = "V7", .hours = 1};
  CheckRow later = row, other = row;
  later.hours = 1.5, other.valve = "V8";
  EXPECT_NE(use_of(row), use_of(later));
  EXPECT_NE(use_of(row), use_of(other));
  EXPECT_EQ(use_of(row), use_of(CheckRow(row)));
}

}  // namespace
}  // namespace servodx
