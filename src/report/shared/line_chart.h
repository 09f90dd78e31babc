// Panels of lines as one SVG picture: for a document, or a browser. No script, no outside file.
#pragma once
#include <string>
#include <utility>
#include <vector>

namespace servodx::report {

struct ChartLine {
  std::string label;  // in the legend; empty: none
  std::vector<double> x, y;
  std::string colour;  // "#rrggbb"; empty: from the scale by position
  bool dots = false;   // points in place of a line
};

struct ChartPanel {
  std::string title, x_label, y_label;
  std::vector<ChartLine> lines;
  std::pair<double, double> x_range = {0, 0}, y_range = {0, 0};  // equal: from the data
  bool log_x = false;
};

// Panels in rows of `columns`.
std::string svg_of(const std::vector<ChartPanel>& panels, int columns);

}  // namespace servodx::report
