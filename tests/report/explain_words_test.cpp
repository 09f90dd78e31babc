// Where a channel's excess gathers, as results and pages say it, to the character.
#include "report/explain/explain_words.h"

#include <gtest/gtest.h>

#include "explain/show.h"

namespace servodx::report {
namespace {

TEST(ExplainWords, SayWhereTheExcessGathers) {
  using Kind = ExcessPlace::Kind;
  EXPECT_EQ(words_of(ExcessPlace{}), "nothing beyond the sensor's noise");
  EXPECT_EQ(words_of(ExcessPlace{Kind::spread}), "the excess is spread evenly");
  EXPECT_EQ(words_of(ExcessPlace{Kind::near_reversal, {}, 0.78, 0.21}),
            "78 % of the excess sits within 30 ms of a reversal (21 % of the time)");
  EXPECT_EQ(words_of(ExcessPlace{Kind::near_jump, {}, 0.504, 0.049}),
            "50 % of the excess sits within 30 ms of a jump of the command (5 % of the time)");
  EXPECT_EQ(words_of(ExcessPlace{Kind::lowest_part, "piston_velocity", 0.6, 0.13}),
            "60 % of the excess sits in the lowest eighth of piston_velocity (13 % of the time)");
  EXPECT_EQ(words_of(ExcessPlace{Kind::highest_part, "command", 0.6, 0.13}),
            "60 % of the excess sits in the highest eighth of command (13 % of the time)");
}

}  // namespace
}  // namespace servodx::report
