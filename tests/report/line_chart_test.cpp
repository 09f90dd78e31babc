#include "report/shared/line_chart.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace servodx::report {
namespace {

struct Place {
  double x = 0, y = 0;
};

// Where a text of the picture begins [px].
Place place_of(const std::string& svg, const std::string& text) {
  const std::size_t end = svg.find(">" + text + "<"), at = svg.rfind("<text x=\"", end);
  EXPECT_NE(end, std::string::npos);
  const std::size_t y = svg.find("y=\"", at + 9);
  return {std::atof(svg.c_str() + at + 9), std::atof(svg.c_str() + y + 3)};
}

TEST(LineChart, LegendOfALongLabelStaysInThePanel) {
  const std::string label = "what the theory says of it, at most";
  const std::string svg = svg_of({{"t", "x", "y", {{label, {0, 1}, {0, 1}}}}}, 1);
  constexpr double panel_width = 420, narrow_letter = 5.5;  // [px]
  EXPECT_LT(place_of(svg, label).x + narrow_letter * static_cast<double>(label.size()), panel_width);
}

TEST(LineChart, LegendStandsWhereTheLinesAreNot) {
  const std::vector<double> x{0, 1, 2, 3}, rising{0, 1, 2, 3}, falling{3, 2, 1, 0};
  const Place of_rising = place_of(svg_of({{"t", "x", "y", {{"label", x, rising}}}}, 1), "label");
  const Place of_falling = place_of(svg_of({{"t", "x", "y", {{"label", x, falling}}}}, 1), "label");
  const auto lower = [](Place p) { return p.y > 150; };
  const auto right = [](Place p) { return p.x > 210; };
  EXPECT_EQ(lower(of_rising), right(of_rising)) << "off the rising diagonal";
  EXPECT_NE(lower(of_falling), right(of_falling)) << "off the falling diagonal";
}

}  // namespace
}  // namespace servodx::report
