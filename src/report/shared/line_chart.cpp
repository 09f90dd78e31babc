#include "report/shared/line_chart.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace servodx::report {
namespace {

constexpr double panel_width = 420, panel_height = 300;         // [px]
constexpr double left = 62, right = 14, top = 30, bottom = 44;  // [px] margins of a panel
constexpr double legend_row = 14, key_width = 18;               // [px]
constexpr double letter = 6.2;                                  // [px] a letter's width in the mean, `font`
constexpr const char* font = "font-family=\"sans-serif\" font-size=\"11\"";

std::string escaped(const std::string& text) {
  std::string out;
  for (char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

// Blue over grey to red, so that the sign of what the lines stand for is seen.
std::string scale_colour(std::size_t k, std::size_t n) {
  const double at = n > 1 ? 2.0 * static_cast<double>(k) / static_cast<double>(n - 1) - 1.0 : 0.0;
  const double fade = 1.0 - std::fabs(at);
  const int low = static_cast<int>(40 + 80 * fade), high = static_cast<int>(200 - 80 * fade);
  return at < 0 ? fmt::format("#{:02x}{:02x}{:02x}", low, static_cast<int>(90 + 30 * fade), high)
                : fmt::format("#{:02x}{:02x}{:02x}", high, static_cast<int>(60 + 60 * fade), low);
}

// 1, 2 or 5 times a power of ten that divides the range in about five.
double tick_step(double range) {
  const double raw = range / 5.0, power = std::pow(10.0, std::floor(std::log10(raw)));
  for (double m : {1.0, 2.0, 5.0})
    if (raw <= m * power) return m * power;
  return 10.0 * power;
}

class Axis {
 public:
  Axis(std::pair<double, double> range, double from, double to, bool log)
      : low_(log ? std::log10(range.first) : range.first),
        high_(log ? std::log10(range.second) : range.second),
        from_(from),
        to_(to),
        log_(log) {}
  double at(double v) const {  // [px]
    return from_ + (to_ - from_) * ((log_ ? std::log10(v) : v) - low_) / (high_ - low_);
  }
  std::vector<double> ticks() const {
    std::vector<double> out;
    if (log_) {
      for (double decade = std::floor(low_); decade <= high_; ++decade)
        for (double m : {1.0, 2.0, 5.0})
          if (const double v = std::log10(m) + decade; v >= low_ - 1e-9 && v <= high_ + 1e-9)
            out.push_back(std::pow(10.0, v));
    } else {
      const double step = tick_step(high_ - low_);
      for (double k = std::ceil(low_ / step - 1e-9); k * step <= high_ + 1e-9 * step; ++k) out.push_back(k * step);
    }
    return out;
  }

 private:
  double low_, high_, from_, to_;
  bool log_;
};

std::pair<double, double> range_of(const std::vector<ChartLine>& lines, std::vector<double> ChartLine::*values) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartLine& line : lines)
    for (double v : line.*values)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  if (!(high > low)) return {std::isfinite(low) ? low - 1 : 0, std::isfinite(low) ? low + 1 : 1};
  return {low, high};
}

// Cut at the panel's upper and lower edge by our own hand: not every viewer knows clip paths.
std::string drawn(const ChartLine& line, const std::string& colour, const Axis& x, const Axis& y,
                  std::pair<double, double> shown) {
  std::string out, path;
  const auto end = [&] {
    if (!path.empty())
      out += fmt::format("<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.4\"/>\n", path, colour);
    path.clear();
  };
  const auto put = [&](double vx, double vy) { path += fmt::format("{:.1f},{:.1f} ", x.at(vx), y.at(vy)); };
  const auto inside = [&](double v) { return v >= shown.first && v <= shown.second; };
  for (std::size_t k = 0; k < line.x.size(); ++k) {
    const double px = line.x[k], py = line.y[k];
    if (!std::isfinite(px) || !std::isfinite(py)) {
      end();
      continue;
    }
    if (line.dots) {
      if (inside(py))
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"1.8\" fill=\"{}\"/>\n", x.at(px), y.at(py), colour);
      continue;
    }
    if (k > 0 && std::isfinite(line.x[k - 1]) && std::isfinite(line.y[k - 1]) && py != line.y[k - 1]) {
      // Where the segment crosses an edge of the panel, in its own direction.
      const double qx = line.x[k - 1], qy = line.y[k - 1];
      const bool up = py > qy;
      for (double edge : {up ? shown.first : shown.second, up ? shown.second : shown.first})
        if ((edge - qy) * (edge - py) < 0) {
          put(qx + (px - qx) * (edge - qy) / (py - qy), edge);
          if (edge == (up ? shown.second : shown.first)) end();
        }
    }
    if (inside(py))
      put(px, py);
    else
      end();
  }
  end();
  return out;
}

struct Box {
  double x0, y0, x1, y1;  // [px]
};

// Of the four corners of `frame` the one that hides least of the lines, the lower right if all are alike.
Box corner_for(double width, double height, const Box& frame, const std::vector<ChartLine>& lines, const Axis& x,
               const Axis& y) {
  constexpr int parts = 16;  // of a stretch between two points
  Box best{};
  long least = std::numeric_limits<long>::max();
  for (const double y0 : {frame.y1 - height, frame.y0})
    for (const double x0 : {frame.x1 - width, frame.x0}) {
      const Box box{x0, y0, x0 + width, y0 + height};
      long hidden = 0;
      const auto see = [&](double px, double py) {
        hidden += px >= box.x0 && px <= box.x1 && py >= box.y0 && py <= box.y1;
      };
      for (const ChartLine& line : lines)
        for (std::size_t k = 0; k < line.x.size(); ++k) {
          const double px = x.at(line.x[k]), py = y.at(line.y[k]);
          if (line.dots || k == 0) {
            see(px, py);
            continue;
          }
          const double from_x = x.at(line.x[k - 1]), from_y = y.at(line.y[k - 1]);
          for (int i = 1; i <= parts; ++i) see(from_x + (px - from_x) * i / parts, from_y + (py - from_y) * i / parts);
        }
      if (hidden < least) best = box, least = hidden;
    }
  return best;
}

std::string panel_svg(const ChartPanel& panel) {
  auto x_range = panel.x_range, y_range = panel.y_range;
  if (!(x_range.second > x_range.first)) x_range = range_of(panel.lines, &ChartLine::x);
  if (!(y_range.second > y_range.first)) {
    y_range = range_of(panel.lines, &ChartLine::y);
    const double room = 0.05 * (y_range.second - y_range.first);
    y_range = {y_range.first - room, y_range.second + room};
  }
  const double x0 = left, x1 = panel_width - right, y0 = panel_height - bottom, y1 = top;
  const Axis x(x_range, x0, x1, panel.log_x), y(y_range, y0, y1, false);
  std::string out = fmt::format("<text x=\"{}\" y=\"{}\" {} font-weight=\"bold\">{}</text>\n", x0, top - 12, font,
                                escaped(panel.title));
  for (double v : x.ticks())
    out += fmt::format(
        "<line x1=\"{0:.1f}\" y1=\"{1}\" x2=\"{0:.1f}\" y2=\"{2}\" stroke=\"#ddd\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" {4} text-anchor=\"middle\">{5:.6g}</text>\n",
        x.at(v), y0, y1, y0 + 15, font, std::fabs(v) < 1e-12 ? 0.0 : v);
  for (double v : y.ticks())
    out += fmt::format(
        "<line x1=\"{1}\" y1=\"{0:.1f}\" x2=\"{2}\" y2=\"{0:.1f}\" stroke=\"#ddd\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" {5} text-anchor=\"end\">{6:.6g}</text>\n",
        y.at(v), x0, x1, x0 - 5, y.at(v) + 4, font, std::fabs(v) < 1e-12 ? 0.0 : v);
  out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#444\"/>\n", x0, y1,
                     x1 - x0, y0 - y1);
  out += fmt::format("<text x=\"{}\" y=\"{}\" {} text-anchor=\"middle\">{}</text>\n", 0.5 * (x0 + x1),
                     panel_height - 10, font, escaped(panel.x_label));
  out += fmt::format("<text transform=\"translate(14,{}) rotate(-90)\" {} text-anchor=\"middle\">{}</text>\n",
                     0.5 * (y0 + y1), font, escaped(panel.y_label));
  std::string legend;
  std::size_t labelled = 0, letters = 0;
  for (const ChartLine& line : panel.lines)
    if (!line.label.empty()) ++labelled, letters = std::max(letters, line.label.size());
  const Box corner = corner_for(key_width + letter * static_cast<double>(letters) + 4,
                                legend_row * static_cast<double>(labelled) + 8, {x0, y1, x1, y0}, panel.lines, x, y);
  const double key = corner.x0 + 4;
  if (labelled > 0)
    legend += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" fill=\"white\" opacity=\"0.8\"/>\n",
        corner.x0 + 1, corner.y0 + 1, corner.x1 - corner.x0 - 2, corner.y1 - corner.y0 - 2);
  double row = corner.y0 + legend_row;
  for (std::size_t k = 0; k < panel.lines.size(); ++k) {
    const ChartLine& line = panel.lines[k];
    const std::string colour = line.colour.empty() ? scale_colour(k, panel.lines.size()) : line.colour;
    out += drawn(line, colour, x, y, y_range);
    if (line.label.empty()) continue;
    legend += line.dots ? fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"3\" fill=\"{}\"/>", key + 7, row - 4, colour)
                        : fmt::format(
                              "<line x1=\"{0}\" y1=\"{1}\" x2=\"{2}\" y2=\"{1}\" stroke=\"{3}\" "
                              "stroke-width=\"2\"/>",
                              key, row - 4, key + 14, colour);
    legend += fmt::format("<text x=\"{}\" y=\"{}\" {}>{}</text>\n", key + key_width, row, font, escaped(line.label));
    row += legend_row;
  }
  return out + legend;
}

}  // namespace

std::string svg_of(const std::vector<ChartPanel>& panels, int columns) {
  const int n = static_cast<int>(panels.size());
  const int wide = std::max(1, std::min(columns, n)), high = (n + wide - 1) / wide;
  std::string out = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      wide * panel_width, high * panel_height);
  for (int k = 0; k < n; ++k)
    out += fmt::format("<g transform=\"translate({},{})\">\n{}</g>\n", (k % wide) * panel_width,
                       (k / wide) * panel_height, panel_svg(panels[static_cast<std::size_t>(k)]));
  return out + "</svg>\n";
}

}  // namespace servodx::report
