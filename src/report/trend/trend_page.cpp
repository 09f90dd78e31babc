#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "prognose/check_name.h"
#include "prognose/level.h"
#include "prognose/life.h"
#include "prognose/trend.h"
#include "prognose/trend_state.h"
#include "report/shared/check_words.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "report/trend/trend_report.h"
#include "report/trend/trend_words.h"
#include "servodx/note.h"
#include "servodx/trend.h"

namespace servodx::report {
namespace {

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

double coverage_of(const Header& header) { return header.settings->value("coverage", 0.9); }

// A check over its hours, with what it must not pass.
Plot history_of(const CheckTrend& t) {
  const HandyUnit unit = unit_of_check(t.unit, t.cause, std::fmax(std::abs(t.healthy), std::abs(t.now)));
  Plot plot{.title = name_of_check(t.name, t.cause) + (unit.name.empty() ? "" : " [" + unit.name + "]"),
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
    table.rows.push_back(
        {name_of_check(t.name, t.cause), state, Cell(size_of_check(t, t.healthy), t.healthy),
         t.points.empty() ? Cell("-") : Cell(size_of_check(t, t.points.back().value), t.points.back().value),
         std::isfinite(t.now) ? Cell(size_of_check(t, t.now), t.now) : Cell("-"), growth(t),
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
          sentence(name_of_check(t.name, t.cause) + " passed its warning level at " + in_hours(*t.alert_at)));
  if (v.state == TrendState::unknown)
    for (const Note& note : v.notes) verdict.reasons.push_back(sentence(note.text));
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

Page trend_page(const Header& header, const std::vector<Trend>& trends, bool all) {
  std::vector<ValveTrend> wholes;
  for (const Trend& t : trends) wholes.push_back(*t.whole);
  return trend_page(header, wholes, all);
}

}  // namespace servodx::report
