#include "report/trend/trend_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "prognose/level.h"
#include "prognose/life.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/trend/trend_words.h"

namespace servodx::report {
namespace {

Json level(const Level& l) {
  return {{"lower", l.lower ? number(*l.lower) : Json(nullptr)}, {"upper", l.upper ? number(*l.upper) : Json(nullptr)}};
}

// Hours; what is never reached is null.
Json remaining_json(const std::optional<Remaining>& r) {
  if (!r) return nullptr;
  return {{"median", number(r->median)}, {"lower", number(r->lower)}, {"upper", number(r->upper)}, {"unit", "h"}};
}

Json hours(const std::optional<double>& h) { return h ? number(*h) : Json(nullptr); }

Json to_json(const CheckTrend& t) {
  Json points = Json::array();
  for (const CheckTrend::Point& p : t.points)
    points.push_back(
        {{"at", p.at}, {"value", number(p.value)}, {"temperature", number(p.temperature)}, {"healthy", p.healthy}});
  Json tangent = nullptr;
  if (t.tangent)
    tangent = {
        {"alert_at", t.tangent->alert_at}, {"time_to_failure", number(t.tangent->time_to_failure)}, {"unit", "h"}};
  return {{"name", t.name.text()},
          {"unit", t.unit},
          {"cause", t.cause.empty() ? Json(nullptr) : Json(t.cause)},
          {"state", word_of(t.state)},
          {"blind", t.blind},
          {"trend", t.trend},
          {"log_bayes_factor", number(t.log_bayes_factor)},
          {"healthy", number(t.healthy)},
          {"now", number(t.now)},
          {"now_error", number(t.now_error)},
          {"slope", number(t.slope)},
          {"slope_unit", t.unit + "/h"},
          {"threshold", level(t.threshold)},
          {"warning", level(t.warning)},
          {"failure", level(t.failure)},
          {"alert_at", hours(t.alert_at)},
          {"to_warning", number(t.to_warning)},
          {"remaining", remaining_json(t.remaining)},
          {"tangent_rule", tangent},
          {"points", points}};
}

std::string life_text(const Remaining& r) {
  return fmt::format("{} ({} to {})", in_hours(r.median), in_hours(r.lower), in_hours(r.upper));
}

}  // namespace

Json to_json(const ValveTrend& v) {
  Json checks = Json::array();
  for (const CheckTrend& t : v.trends) checks.push_back(to_json(t));
  return {{"valve", v.valve},
          {"serial", v.serial},
          {"state", word_of(v.state)},
          {"at", v.at},
          {"unit", "h"},
          {"recorded", v.checks},
          {"cause", v.cause ? Json(*v.cause) : Json(nullptr)},
          {"alert_at", hours(v.alert_at)},
          {"to_warning", number(v.to_warning)},
          {"remaining", remaining_json(v.remaining)},
          {"checks", checks}};
}

Json trend_json(const std::vector<Trend>& trends, bool all) {
  if (!all) return to_json(*trends.front().whole);
  Json valves = Json::array();
  for (const Trend& t : trends) valves.push_back(to_json(*t.whole));
  return {{"valves", valves}};
}

std::string text_of(const ValveTrend& v) {
  std::string text =
      fmt::format("{}: {}; last check at {} h, {} checks\n", v.valve, word_of(v.state), digits(v.at, 5), v.checks);
  if (v.cause) text += fmt::format("  cause        {}\n", *v.cause);
  if (v.alert_at) text += fmt::format("  alert        at {} h\n", digits(*v.alert_at, 5));
  if (v.remaining) text += fmt::format("  life left    {}\n", life_text(*v.remaining));
  Columns rows("llllllll", 2);
  rows.row({"check", "state", "began", "last", "by law", "warning", "failure", "life left"});
  for (const CheckTrend& t : v.trends) {
    const auto bounds = [&](const Level& l) {
      std::string s;
      if (l.lower) s += "under " + handy(*l.lower, t.unit);
      if (l.upper) s += (s.empty() ? "over " : ", over ") + handy(*l.upper, t.unit);
      return s.empty() ? std::string("-") : s;
    };
    rows.row({t.cause.empty() ? t.name.text() : t.name.text() + " (" + t.cause + ")",
              t.trend ? word_of(t.state) : std::string(word_of(t.state)) + ", no trend", handy(t.healthy, t.unit),
              t.points.empty() ? "-" : handy(t.points.back().value, t.unit),
              std::isfinite(t.now) ? handy(t.now, t.unit) : "-", bounds(t.warning), bounds(t.failure),
              t.remaining ? life_text(*t.remaining) : "-"});
  }
  return text + rows.text();
}

std::string ranking(const std::vector<Trend>& trends) {
  Columns rows("lllrll");
  rows.row({"valve", "state", "cause", "at", "to warning", "life left"});
  for (const Trend& t : trends) {
    const ValveTrend& v = *t.whole;
    rows.row({v.valve, word_of(v.state), v.cause.value_or("-"), digits(v.at, 5) + " h",
              v.to_warning > 0 ? in_hours(v.to_warning) : "passed", v.remaining ? life_text(*v.remaining) : "-"});
  }
  return rows.text();
}

}  // namespace servodx::report
