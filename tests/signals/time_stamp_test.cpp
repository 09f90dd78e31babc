// Date-time stamps are times: seconds from the first, to the nanosecond.
#include "signals/time_stamp.h"

#include <gtest/gtest.h>

namespace servodx {
namespace {

double seconds_between(const char* first, const char* then) {
  const auto a = parse_time_stamp(first), b = parse_time_stamp(then);
  return a && b ? StampClock(*a).seconds(*b).value_or(-2) : -1;
}

TEST(TimeStamp, FormsThatLoggersWriteAreSeconds) {
  EXPECT_EQ(seconds_between("2021-03-04 10:11:12.000000", "2021-03-04 10:11:12.001000"), 1e-3);
  EXPECT_EQ(seconds_between("2021-03-04T10:11:12Z", "2021-03-04T10:12:12.5Z"), 60.5);
  EXPECT_EQ(seconds_between("2021-03-04T10:11:12+01:00", "2021-03-04T10:11:12+00:00"), 3600);
  EXPECT_EQ(seconds_between("2021/03/04 10:11:12", "2021/03/05 10:11:12"), 86400);
  EXPECT_EQ(seconds_between("28.02.2024 23:59:59,999", "29.02.2024 00:00:00,000"), 1e-3);
  EXPECT_EQ(seconds_between("10:11:12.25", "10:11:12.50"), 0.25);
  EXPECT_EQ(seconds_between("28.02.24 23:59:59,999", "29.02.24 00:00:00,000"), 1e-3);
  EXPECT_EQ(seconds_between("11:59.500", "12:00.250"), 0.75);
  EXPECT_EQ(seconds_between("11:59:59.5 AM", "12:00:00 PM"), 0.5);
  EXPECT_EQ(seconds_between("12:59:59 PM", "1:00:00 PM"), 1);
}

// April the third or March the fourth: the clock counts, and midnight is one day.
TEST(TimeStamp, OfADateWhoseOrderNobodyCanTellTheClockCounts) {
  EXPECT_EQ(seconds_between("03/04/2021 10:11:59.500", "03/04/2021 10:12:00.250"), 0.75);
  EXPECT_EQ(seconds_between("03/04/2021 23:59:59.5", "03/05/2021 00:00:00"), 0.5);
  EXPECT_EQ(seconds_between("03/04/2021 23:59:59.5", "04/04/2021 00:00:00"), 0.5);
  EXPECT_EQ(seconds_between("4/3/21 11:59:59 PM", "4/4/21 12:00:00 AM"), 1);
  EXPECT_EQ(seconds_between("21-03-04 10:11:12", "21-03-04 10:11:13"), 1);
}

TEST(TimeStamp, AClockGoesOnOverMidnight) {
  StampClock clock(*parse_time_stamp("23:59:59.5"));
  EXPECT_EQ(clock.seconds(*parse_time_stamp("23:59:59.75")), 0.25);
  EXPECT_EQ(clock.seconds(*parse_time_stamp("00:00:00.5")), 1.0);
  EXPECT_EQ(clock.seconds(*parse_time_stamp("00:00:00.75")), 1.25);
  EXPECT_FALSE(clock.seconds(*parse_time_stamp("2021-03-04 00:00:01")));
  EXPECT_FALSE(clock.seconds(*parse_time_stamp("00:01.5")));
}

TEST(TimeStamp, MinutesGoOnOverTheHour) {
  StampClock clock(*parse_time_stamp("59:59.5"));
  EXPECT_EQ(clock.seconds(*parse_time_stamp("59:59.75")), 0.25);
  EXPECT_EQ(clock.seconds(*parse_time_stamp("00:00.5")), 1.0);
  EXPECT_EQ(clock.seconds(*parse_time_stamp("00:00.75")), 1.25);
}

TEST(TimeStamp, WhatIsNoneIsNone) {
  for (const char* text :
       {"", "1.5", "10:11", "2021-03-04", "2021-13-04 10:11:12", "2021-02-30 10:11:12", "25:00:00", "10:60:00",
        "10:11:12x", "13/14/2021 10:11:12", "2021-03-04 10:11:12 +1", "13:00:00 PM", "00:00:00 AM", "11:60.5"})
    EXPECT_FALSE(parse_time_stamp(text)) << text;
  EXPECT_TRUE(is_date("2021-03-04"));
  EXPECT_TRUE(is_date("04.03.2021"));
  EXPECT_TRUE(is_date("03/04/21"));
  EXPECT_FALSE(is_date("1.5"));
  EXPECT_FALSE(is_date("04.03"));
}

}  // namespace
}  // namespace servodx
