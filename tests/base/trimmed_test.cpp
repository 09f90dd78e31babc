#include "base/trimmed.h"

#include <gtest/gtest.h>

namespace servodx {
namespace {

TEST(Trimmed, LeavesWhatStandsBetweenTheBlanks) {
  EXPECT_EQ(trimmed(" \ta b\t"), "a b");
  EXPECT_EQ(trimmed("a"), "a");
  EXPECT_EQ(trimmed(" \t "), "");
  EXPECT_EQ(trimmed(""), "");
  EXPECT_EQ(trimmed("\"a\"\r"), "\"a\"\r");
  EXPECT_EQ(trimmed("\"a\"\r", " \t\r\""), "a");
}

}  // namespace
}  // namespace servodx
