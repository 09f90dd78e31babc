#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "base/celsius.h"
#include "prognose/check.h"
#include "prognose/oil_temperature.h"
#include "report/check/check_report.h"
#include "report/shared/check_words.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"

namespace servodx::report {
namespace {

// Of the way from the tuned table to the fault's own level of failure; NaN of the paper's checks.
double way(const Check& c, double value) { return (value - c.tuned) / (c.failed - c.tuned); }
double way_error(const Check& c) { return std::abs(c.std_error / (c.failed - c.tuned)); }

// Wear that reads a quarter of the way, where `trend` would warn of it, beyond what noise does; the farthest.
const Check* worn(const CheckResult& r) {
  constexpr double far = 0.25, sure = 2.0;
  const Check* most = nullptr;
  for (const Check& c : r.checks)
    if (way(c, c.value) - sure * way_error(c) > far && (!most || way(c, c.value) > way(*most, most->value))) most = &c;
  return most;
}

std::string capital(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

void add_ways(Page& page, const CheckResult& r) {
  Bars bars{"From the tuned table to failure", "wear", "of the way", {}, Mark{1.0, "failed"}, 1.15};
  for (const Check& c : r.checks)
    if (std::isfinite(way(c, c.value)))
      bars.rows.push_back(
          {words(c.cause), std::max(0.0, way(c, c.value)), percent(way(c, c.value)),
           fmt::format("+- {}; {}, tuned {}, failed at {}", percent(way_error(c)), size_of_check(c, c.value),
                       size_of_check(c, c.tuned), size_of_check(c, c.failed)),
           &c == worn(r) ? Tone::doubt : Tone::plain, ""});
  if (bars.rows.empty()) return;
  std::stable_sort(bars.rows.begin(), bars.rows.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  page.section("How far each wear has come",
               "The fault's own level of failure. An error as long as its bar: this log does not determine the wear.");
  page.add(bars);
}

}  // namespace

Page check_page(const Header& header, const CheckResult& r, const std::vector<double>& time) {
  Page page(header, "Checks of " + file_name(r.log));
  Verdict v;
  const Check* most = worn(r);
  v.tone = r.no_response ? Tone::bad : Tone::plain;
  v.headline = r.no_response ? "The spool did not follow the step"
               : most        ? capital(fmt::format("{} reads {} of the way to failure: {}", words(most->cause),
                                                   percent(way(*most, most->value)), size_of_check(*most, most->value)))
               : std::any_of(r.checks.begin(), r.checks.end(), [](const Check& c) { return !c.cause.empty(); })
                   ? "No wear reads a quarter of the way to failure or more"
                   : fmt::format("{} checks; wear was not estimated", r.checks.size());
  v.detail =
      "A reading, no verdict: healthy logs of other kinds or oils read apart by far more than the errors below. "
      "What it means for this valve, its history says (servodx trend).";
  v.facts = {{"Checks recorded", std::to_string(r.checks.size())},
             {"Oil", digits(r.temperature.value - zero_celsius) + " degC, " + name_of(r.temperature.source)},
             {"Offset of the current", percent(r.offset) + " of rated"},
             {"Fit of the model", digits(r.adequacy, 2) + " times its usual error"}};
  if (r.null) v.facts.push_back({"Null", percent(*r.null) + " of rated"});
  constexpr double poor = 4.0;  // times the usual error
  if (r.adequacy > poor)
    v.reasons.push_back("The model follows this log " + digits(r.adequacy, 2) +
                        " times worse than those that tuned it: a size read off it may be another cause's.");
  page.verdict(v);
  add_ways(page, r);
  page.section("Checks", "As measured, and corrected to 40 degC oil and the supply of the tuned table.");
  TablePart table{
      "Checks", "lrrrr", {"check", "measured", "model: here over at 40 degC", "corrected", "standard error"}, {}, 0};
  for (const Check& c : r.checks)
    table.rows.push_back({name_of_check(c.name, c.cause), Cell(size_of_check(c, c.measured), c.measured),
                          c.cause.empty() ? Cell(digits(c.expected), c.expected) : Cell(""),
                          Cell(size_of_check(c, c.value), c.value), Cell(size_of_check(c, c.std_error), c.std_error)});
  page.add(table);
  if (r.mean_error.running.size() == time.size() && !time.empty()) {
    Plot plot{.title = "running mean of |e| [um]", .x_label = "time [s]", .x = time};
    Series s{"|e|", r.mean_error.running, Role::measured};
    for (double& y : s.y) y *= 1e6;
    plot.series = {s};
    if (r.mean_error.settled) plot.x_marks = {{r.mean_error.settled_at, "settled"}};
    page.section("Mean error", "Between measured and monitored spool, over the time so far.");
    page.add(plot);
  }
  return page;
}

}  // namespace servodx::report
