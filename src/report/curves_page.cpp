#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/units.h"
#include "report/curves.h"
#include "report/handy.h"
#include "report/replay_part.h"

namespace servodx::report {
namespace {

using curves::Figure;
using curves::Sheet;

std::string display_unit(Signal signal) {
  const std::string si(info(signal).si_unit);
  return si == "m3/s" ? "l/min" : si == "Pa" ? "bar" : si == "m" ? "mm" : si;
}

Plot branches(const curves::SweepCurve& c, double rated_current) {
  const std::string unit = display_unit(c.signal), name = words(std::string(info(c.signal).name));
  const auto scaled = [&](std::vector<double> y) {
    for (double& v : y) v = find_unit(unit)->from_si(v);
    return y;
  };
  Plot plot{.title = name + " [" + unit + "]", .x_label = "current [% of rated]", .x = c.current, .group = "sweep"};
  for (double& x : plot.x) x *= 100 / rated_current;
  plot.series = {{"rising", scaled(c.up), Role::measured}, {"falling", scaled(c.down), Role::named}};
  return plot;
}

void add_response(Page& page, const Sheet& sheet) {
  Plot gain{.title = "amplitude ratio [dB]", .x_label = "frequency [Hz]", .group = "bode"};
  Plot phase{.title = "phase [deg]", .x_label = "frequency [Hz]", .group = "bode"};
  Series a{"amplitude", {}, Role::measured}, p{"phase", {}, Role::measured};
  for (const curves::ResponsePoint& r : sheet.response) {
    gain.x.push_back(r.frequency), phase.x.push_back(r.frequency);
    a.y.push_back(20 * std::log10(r.gain / sheet.response.front().gain));
    p.y.push_back(r.phase * 180 / std::numbers::pi);
  }
  gain.series = {a}, phase.series = {p};
  gain.y_marks = {{-3, "-3 dB"}};
  phase.y_marks = {{-90, "-90 deg"}};
  page.section("Frequency response", "Of " + words(sheet.response_signal) + " to current, over its lowest point.");
  page.add(gain);
  page.add(phase);
}

}  // namespace

Page curves_page(const Header& header, const Sheet& sheet, const std::string& log, double rated_current) {
  Page page(header, "Acceptance sheet of " + file_name(log));
  Verdict v;
  v.tone = sheet.verdict == "pass" ? Tone::good : sheet.verdict == "fail" ? Tone::bad : Tone::plain;
  v.word = sheet.verdict == "pass" ? "PASS" : sheet.verdict == "fail" ? "FAIL" : "NOT JUDGED";
  const auto judged =
      std::count_if(sheet.figures.begin(), sheet.figures.end(), [](auto& f) { return f.pass.has_value(); });
  const auto failed =
      std::count_if(sheet.figures.begin(), sheet.figures.end(), [](auto& f) { return f.pass && !*f.pass; });
  v.headline = judged == 0  ? "The rig file gives no limit that this log can be judged by"
               : failed > 0 ? std::to_string(failed) + " of " + std::to_string(judged) + " limits are broken"
                            : "All " + std::to_string(judged) + " limits are kept";
  for (const Figure& f : sheet.figures)
    if (f.pass && !*f.pass) v.reasons.push_back(words(f.name) + ": " + readable(f, f.value) + ", " + limit_text(f));
  page.verdict(v);

  page.section("Figures", "As SAE ARP490 defines them. Percentages are of rated current.");
  TablePart table{"Figures", "lrllll", {"figure", "value", "limit", "", "from", "note"}, {}, 0};
  for (const Figure& f : sheet.figures) {
    Cell judgement = f.pass ? (*f.pass ? "pass" : "FAIL") : "";
    judgement.tone = f.pass ? (*f.pass ? Tone::good : Tone::bad) : Tone::plain;
    table.rows.push_back({words(f.name), std::isfinite(f.value) ? Cell(readable(f, f.value), f.value) : Cell("-"),
                          limit_text(f), judgement, words(f.signal), f.note});
  }
  page.add(table);
  if (!sheet.curves.empty())
    page.section("Sweeps",
                 "Both branches over current. What lies between them is hysteresis and the lag of the meter.");
  for (const curves::SweepCurve& c : sheet.curves) page.add(branches(c, rated_current));
  if (!sheet.response.empty()) add_response(page, sheet);
  return page;
}

}  // namespace servodx::report
