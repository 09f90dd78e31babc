// What is remarked of a standard figure, as sheets say it, to the character.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "curves/curves.h"
#include "report/curves/curves.h"

namespace servodx::report {
namespace {

TEST(FigureWords, AreTheSameToTheCharacter) {
  using Kind = curves::Remark::Kind;
  const struct {
    curves::Remark remark;
    const char* words;
  } cases[] = {
      {{}, ""},
      {{Kind::too_fast, 1.333},
       "cannot be determined: the command sweeps 1.3 times rated current a second, at most 1 is slow enough"},
      {{Kind::one_way}, "cannot be determined: the command sweeps one way only"},
      {{Kind::coarse_readings, 0.01234}, "cannot be determined: the readings resolve 1.2 % of rated current"},
      {{Kind::short_command, -80.04, 91.26}, "the command reaches -80 to 91.3 % of rated"},
      {{Kind::coarse_command, 0.512, 0.4321},
       "cannot be determined: the command's steps are 0.51 % of rated, and the gain is at least 43.2 % of supply per 1 "
       "%"},
      {{Kind::not_reached, 123.4}, "not reached: the log shows up to 123 Hz"},
      {{Kind::not_shown}, "not shown by this log"},
      {{Kind::mean_of_reversals, 12, 0.00456}, "mean of 12 reversals, resolved to 0.46 % of rated"},
      {{Kind::brought_to_rated_drop, 6.9876e6, 7e6}, "from a drop of 69.88 bar to the rated 70 bar"},
      {{Kind::of_largest_pressure}, "supply unknown: of the largest load pressure"},
      {{Kind::positive_is_overlap}, "positive is overlap"},
      {{Kind::pilot_stage_included}, "pilot stage included"},
      {{Kind::least_of_sweep}, "least of the sweep; with the edges' leakage at its end"},
      {{Kind::at_half_height}, "at half height of the peak"},
      {{Kind::at_rated_current}, "at rated current"},
  };
  for (std::size_t k = 0; k < std::size(cases); ++k) {
    EXPECT_EQ(words_of(cases[k].remark), cases[k].words);
    EXPECT_EQ(static_cast<std::size_t>(cases[k].remark.kind), k) << "each kind has its words";
  }
}

TEST(FigureWords, StandInResultAndText) {
  curves::Sheet sheet;
  sheet.figures = {{.name = "hysteresis",
                    .signal = "control_flow",
                    .value = std::nan(""),
                    .unit = "-",
                    .remark = {curves::Remark::Kind::one_way}}};
  EXPECT_EQ(curves_json(sheet)["figures"][0]["note"], "cannot be determined: the command sweeps one way only");
  EXPECT_NE(text_of(sheet, "log.csv", false).find("sweeps one way only"), std::string::npos);
}

}  // namespace
}  // namespace servodx::report
