// `init` reads a log of unknown names within the limits of one that is checked.
#include "signals/log_header.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "temporary_folder.h"

namespace servodx {
namespace {

const std::string names = "time [s],command [mA],spool [mm]\n";

std::string refusal(const std::string& text) {
  const TemporaryFolder folder;
  const std::string path = folder.write("log.csv", text);
  try {
    read_log_header(path);
  } catch (const InputError& error) {
    return std::string(error.what()).substr(folder.path.string().size() + 1);
  }
  return "accepted";
}

TEST(LogHeader, OfRowsWithoutEndIsRefusedWhereTheyPassTheLimit) {
  const std::string long_row = "the row is longer than 16 MB; end each row with a line end, and close quotes";
  EXPECT_EQ(refusal(names + std::string(50'000'000, ',')), "log.csv:2: " + long_row);
  EXPECT_EQ(refusal(names + "0,1,2\n" + std::string(50'000'000, 'x')), "log.csv:3: " + long_row);
  EXPECT_EQ(refusal(names + "0,1,2\n1,2,\"" + std::string(50'000'000, 'x')), "log.csv:3: " + long_row);
}

// The row is read to its end before the lines behind it are looked at, as `check-log` does.
TEST(LogHeader, ASecondHeaderIsRefusedWhereverItsWordsStand) {
  const std::string said = ": a second header: the file holds several recordings; cut it into a file for each";
  EXPECT_EQ(refusal(names + "0,1,2\n1,1,2\n" + names + "0,1,2\n"), "log.csv:4" + said);
  EXPECT_EQ(refusal(names + "0,1,2\nend,1,2\n" + names + "0,1,2\n"), "log.csv:3" + said);
}

// LabVIEW's units stand some lines above the names, and the rows below may be many.
TEST(LogHeader, UnitsAboveTheNamesOutliveALongLog) {
  const TemporaryFolder folder;
  std::string text = "LabVIEW Measurement\nY_Unit_Label\tmA\tmm\n***End_of_Header***\nX_Value\tcommand\tspool\n";
  for (int k = 0; k < 100'000; ++k) text += "0." + std::to_string(100'000 + k) + "\t1\t2\n";
  const LogHeader header = read_log_header(folder.write("log.lvm", text));
  ASSERT_EQ(header.numbers.size(), 3u);
  EXPECT_EQ(header.numbers[0].count, 100'000);
  EXPECT_EQ(header.columns[1].unit, "mA");
  EXPECT_EQ(header.columns[2].unit, "mm");
}

}  // namespace
}  // namespace servodx
