// Where a channel's excess gathers: what stands out by its share for its time, and what does not.
#include "explain/show.h"

#include <gtest/gtest.h>

#include <vector>

namespace servodx {
namespace {

using Kind = ExcessPlace::Kind;

TEST(Show, TheExcessGathersWhereItsShareIsLargestForItsTime) {
  const ExcessPlace reversal{Kind::near_reversal, {}, 0.78, 0.21}, jump{Kind::near_jump, {}, 0.5, 0.49},
      lowest{Kind::lowest_part, "spool_position", 0.6, 0.125}, small{Kind::highest_part, "command", 0.25, 0.01},
      never{Kind::near_jump, {}, 0.9, 0};
  const struct {
    std::vector<ExcessPlace> places;
    Kind kind;
  } cases[] = {
      {{reversal, jump}, Kind::near_reversal},
      {{jump, reversal}, Kind::near_reversal},
      {{reversal, jump, lowest}, Kind::near_reversal},  // 0.78 ln(0.78 / 0.21) is above 0.6 ln(0.6 / 0.125)
      {{jump, lowest}, Kind::lowest_part},
      {{jump}, Kind::spread},   // half of the excess in half of the time
      {{small}, Kind::spread},  // a quarter says little, however short
      {{never}, Kind::spread},
      {{}, Kind::spread},
  };
  for (const auto& c : cases) EXPECT_EQ(where_most_gathers(c.places).kind, c.kind) << &c - cases;
  const ExcessPlace told = where_most_gathers({jump, lowest});
  EXPECT_EQ(told.variable, "spool_position");
  EXPECT_EQ(told.share, 0.6);
  EXPECT_EQ(told.time, 0.125);
}

}  // namespace
}  // namespace servodx
