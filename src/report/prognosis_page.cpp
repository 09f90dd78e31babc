#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/celsius.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/level.h"
#include "prognose/life.h"
#include "prognose/trend.h"
#include "prognose/trend_state.h"
#include "report/diagnosis_words.h"
#include "report/handy.h"
#include "report/json.h"
#include "report/page.h"
#include "report/parts.h"
#include "report/prognosis.h"
#include "report/prognosis_words.h"
#include "report/replay_part.h"

namespace servodx::report {
namespace {

// "clogged filter (row 1)", and the paper's checks by their symbols.
std::string named(const CheckName& check, const std::string& cause) {
  if (!cause.empty()) {
    const bool row = check.kind() == CheckKind::parameter && !check.detail().empty();
    return words(cause) + " (" + (row ? "row " + check.detail() : check.text()) + ")";
  }
  switch (check.kind()) {
    case CheckKind::mean_error:
      return "mean error |e|";
    case CheckKind::fidelity:
      return "fidelity r";
    case CheckKind::correlation:
      return check.detail().empty() ? check.text() : "correlation E(tau) at " + check.detail();
    default:
      return check.text();
  }
}

// A part lost (of the filter's area) reads as per cent.
HandyUnit unit_of(const std::string& unit, const std::string& cause, double magnitude) {
  return unit == "-" && !cause.empty() ? HandyUnit{"%", 100.0} : handy_unit(unit, magnitude);
}
std::string size_of(const std::string& unit, const std::string& cause, double value) {
  const HandyUnit in = unit_of(unit, cause, value);
  return digits(value * in.factor) + (in.name.empty() ? "" : " " + in.name);
}
template <class C>
std::string size_of(const C& check, double value) {
  return size_of(check.unit, check.cause, value);
}

std::string in_hours(double h) { return std::isfinite(h) ? digits(h) + " h" : "never"; }

Tone tone_of(TrendState state) {
  if (state == TrendState::failed || state == TrendState::warning) return Tone::bad;
  return state == TrendState::healthy ? Tone::good : Tone::doubt;
}

std::string left(const std::optional<Remaining>& r, double coverage) {
  if (!r) return "not predicted";
  return in_hours(r->median) + " (" + in_hours(r->lower) + " to " + in_hours(r->upper) + ", " + percent(coverage) + ")";
}

// A confirmed trend to the other side than the one level of failure lies on: a repair, or a table that is wrong.
bool moves_away(const CheckTrend& t) {
  if (!t.trend || t.failure.upper.has_value() == t.failure.lower.has_value()) return false;
  return t.failure.upper ? t.now < t.healthy : t.now > t.healthy;
}

// Odds in which a person believes; the figure itself is in the JSON.
std::string growth(const CheckTrend& t) {
  if (!t.trend) return "none shown";
  constexpr double most = 1000;
  const double odds = std::exp(std::min(t.log_bayes_factor, std::log(2 * most)));
  return std::string(t.now < t.healthy ? "falls, " : "rises, ") + (moves_away(t) ? "away from failure, " : "") +
         (odds > most ? "over 1000 to 1" : digits(odds, 2) + " to 1");
}

double coverage_of(const Header& header) { return header.settings.value("coverage", 0.9); }

// A check over its hours, with what it must not pass.
Plot history_of(const CheckTrend& t) {
  const HandyUnit unit = unit_of(t.unit, t.cause, std::fmax(std::abs(t.healthy), std::abs(t.now)));
  Plot plot{.title = named(t.name, t.cause) + (unit.name.empty() ? "" : " [" + unit.name + "]"),
            .x_label = "hours of use",
            .group = "life"};
  Series healthy{"taken as healthy", {}, Role::reference, true}, watched{"watched", {}, Role::measured, true};
  for (const CheckTrend::Point& p : t.points) {
    plot.x.push_back(p.at);
    healthy.y.push_back(p.healthy ? p.value * unit.factor : std::nan(""));
    watched.y.push_back(p.healthy ? std::nan("") : p.value * unit.factor);
  }
  for (const Series& s : {healthy, watched})  // a legend of what is not there would look for dots
    if (std::any_of(s.y.begin(), s.y.end(), [](double y) { return std::isfinite(y); })) plot.series.push_back(s);
  const auto mark = [&](const Level& level, const char* label) {
    for (const auto& bound : {level.lower, level.upper})
      if (bound && std::isfinite(*bound)) plot.y_marks.push_back({*bound * unit.factor, label});
  };
  mark(t.threshold, "threshold");
  mark(t.warning, "warning");
  mark(t.failure, "failure");
  if (t.alert_at) plot.x_marks.push_back({*t.alert_at, "alert"});
  return plot;
}

// The chance to be failed by an hour, from sorted hours each as likely as the other.
std::optional<Plot> life_plot(const Life& life, double now) {
  Plot plot{.title = "chance of having failed [%]", .x_label = "hours of use"};
  Series s{"predicted", {}, Role::named};
  for (std::size_t k = 0; k < life.size() && std::isfinite(life[k]); ++k) {
    plot.x.push_back(now + life[k]);
    s.y.push_back(100.0 * static_cast<double>(k + 1) / static_cast<double>(life.size()));
  }
  if (plot.x.size() < 2) return {};
  plot.series = {s};
  return plot;
}

TablePart table_of(const ValveTrend& v, double coverage) {
  TablePart table{"Checks of " + v.valve,
                  "llrrrll",
                  {"check", "state", "began", "last reading", "by its law", "trend", "life left"},
                  {},
                  0};
  for (const CheckTrend& t : v.trends) {
    Cell state = word_of(t.state);
    state.tone = tone_of(t.state);
    table.rows.push_back({named(t.name, t.cause), state, Cell(size_of(t, t.healthy), t.healthy),
                          t.points.empty() ? Cell("-") : Cell(size_of(t, t.points.back().value), t.points.back().value),
                          std::isfinite(t.now) ? Cell(size_of(t, t.now), t.now) : Cell("-"), growth(t),
                          moves_away(t) ? "not towards failure" : left(t.remaining, coverage)});
  }
  return table;
}

void add_valve(Page& page, const ValveTrend& v, double coverage, bool folded) {
  page.section(
      "Checks of " + v.valve,
      "Corrected to 40 degC oil. A trend is confirmed before anything is predicted; \"none shown\" is an answer.",
      folded);
  page.add(table_of(v, coverage));
  if (const auto life = life_plot(v.life, v.at)) page.add(*life);
  // What moves first, then the rest.
  std::vector<const CheckTrend*> order;
  for (const CheckTrend& t : v.trends) order.push_back(&t);
  std::stable_sort(order.begin(), order.end(),
                   [](auto* a, auto* b) { return a->log_bayes_factor > b->log_bayes_factor; });
  for (const CheckTrend* t : order)
    if (t->points.size() > 1) page.add(history_of(*t));
}

Verdict verdict_of(const ValveTrend& v, double coverage) {
  Verdict verdict;
  verdict.tone = tone_of(v.state);
  verdict.word = word_of(v.state);
  std::transform(verdict.word.begin(), verdict.word.end(), verdict.word.begin(),
                 [](unsigned char c) { return std::toupper(c); });
  verdict.headline = v.cause      ? words(*v.cause) + " grows in " + v.valve
                     : v.alert_at ? "A check of " + v.valve + " grows; no parameter names the cause"
                     : std::any_of(v.trends.begin(), v.trends.end(), moves_away)
                         ? v.valve + " shows no growth towards failure, but a check that moves away from it"
                     : v.state == TrendState::unknown
                         ? fmt::format("Nothing is known yet of how {} wears, after {} check{}", v.valve, v.checks,
                                       v.checks == 1 ? "" : "s")
                         : v.valve + " shows no growth that would be acted on";
  if (v.cause && v.remaining && std::isfinite(v.remaining->median))
    verdict.headline += ", about " + digits(v.remaining->median, 2) + " h left";
  verdict.facts = {{"Valve", v.serial.empty() ? v.valve : v.valve + ", serial " + v.serial},
                   {"Last check", in_hours(v.at)},
                   {"Checks recorded", std::to_string(v.checks)},
                   {"Alert", v.alert_at ? "at " + in_hours(*v.alert_at) : "none"},
                   {"Life left", left(v.remaining, coverage)}};
  for (const CheckTrend& t : v.trends)
    if (t.alert_at)
      verdict.reasons.push_back(
          sentence(named(t.name, t.cause) + " passed its warning level at " + in_hours(*t.alert_at)));
  if (v.state == TrendState::unknown)
    for (const std::string& note : v.notes) verdict.reasons.push_back(sentence(note));
  return verdict;
}

}  // namespace

Page trend_page(const Header& header, const std::vector<ValveTrend>& trends, bool all) {
  const double coverage = coverage_of(header);
  Page page(header, all ? "Fleet of " + std::to_string(trends.size()) + " valves" : "Trend of " + trends.front().valve);
  if (!all) {
    page.verdict(verdict_of(trends.front(), coverage));
    add_valve(page, trends.front(), coverage, false);
    return page;
  }
  const auto alerts =
      std::count_if(trends.begin(), trends.end(), [](const ValveTrend& v) { return v.alert_at.has_value(); });
  Verdict v;
  v.tone = alerts > 0 ? Tone::bad : Tone::good;
  v.headline = alerts > 0 ? fmt::format("{} of {} valves {} raised an alert", alerts, trends.size(),
                                        alerts == 1 ? "has" : "have")
                          : "No valve has raised an alert";
  for (const ValveTrend& t : trends)
    if (t.alert_at)
      v.reasons.push_back(fmt::format("{}: {}, at {}; life left {}", t.valve,
                                      t.cause ? words(*t.cause) : "no cause named", in_hours(*t.alert_at),
                                      left(t.remaining, coverage)));
  page.verdict(v);
  page.section("Ranking");
  TablePart table{"The first to reach its warning level first",
                  "lllrll",
                  {"valve", "state", "cause", "at", "to warning", "life left"},
                  {},
                  0};
  for (const ValveTrend& t : trends) {
    Cell state = word_of(t.state);
    state.tone = tone_of(t.state);
    table.rows.push_back({t.valve, state, t.cause ? words(*t.cause) : "-", Cell(in_hours(t.at), t.at),
                          t.to_warning > 0 ? in_hours(t.to_warning) : "passed", left(t.remaining, coverage)});
  }
  page.add(table);
  for (const ValveTrend& t : trends) add_valve(page, t, coverage, &t != &trends.front());
  return page;
}

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
      bars.rows.push_back({words(c.cause), std::max(0.0, way(c, c.value)), percent(way(c, c.value)),
                           fmt::format("+- {}; {}, tuned {}, failed at {}", percent(way_error(c)), size_of(c, c.value),
                                       size_of(c, c.tuned), size_of(c, c.failed)),
                           &c == worn(r) ? Tone::doubt : Tone::plain, ""});
  if (bars.rows.empty()) return;
  std::stable_sort(bars.rows.begin(), bars.rows.end(), [](const auto& a, const auto& b) { return a.value > b.value; });
  page.section("How far each wear has come",
               "The fault's own level of failure. An error as long as its bar: this log does not tell.");
  page.add(bars);
}

Page check_page(const Header& header, const CheckResult& r, const std::vector<double>& time) {
  Page page(header, "Checks of " + file_name(r.log));
  Verdict v;
  const Check* most = worn(r);
  v.tone = r.no_response ? Tone::bad : Tone::plain;
  v.headline = r.no_response ? "The spool did not follow the step"
               : most        ? capital(fmt::format("{} reads {} of the way to failure: {}", words(most->cause),
                                                   percent(way(*most, most->value)), size_of(*most, most->value)))
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
    table.rows.push_back({named(c.name, c.cause), Cell(size_of(c, c.measured), c.measured),
                          c.cause.empty() ? Cell(digits(c.expected), c.expected) : Cell(""),
                          Cell(size_of(c, c.value), c.value), Cell(size_of(c, c.std_error), c.std_error)});
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
