// `servodx check-log`: what no valve does stands out from what is only suspicious.
#include <gtest/gtest.h>

#include <sstream>

#include "program.h"

namespace servodx {
namespace {

TEST(CheckLog, AReturnAboveTheSupplyIsSaidLoudly) {
  const Desk desk;
  std::istringstream in(small_log());
  std::string text, line;
  while (std::getline(in, line)) text += line + (text.empty() ? ",return_pressure [bar]\n" : ",300\n");
  desk.write("log.csv", text);
  desk.write("good.csv", small_log());
  const Ended ended = desk.run("check-log log.csv good.csv");
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(
      ended.out.find("  IMPOSSIBLE: swapped: 'return_pressure' is above 'supply_pressure' in 100 % of the samples"),
      std::string::npos)
      << ended.out;
  EXPECT_EQ(ended.out.find("'pressure_a' is below 'return_pressure'"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("; IMPOSSIBLE in 1\n"), std::string::npos) << ended.out;
}

}  // namespace
}  // namespace servodx
