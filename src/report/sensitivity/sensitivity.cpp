#include "report/sensitivity/sensitivity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/log.h"

namespace servodx::report {
namespace {

constexpr std::size_t rows_shown = 45;  // the 41, and no more than a few of effects

std::string id_of(const DrivenRow& r) { return r.id > 0 ? std::to_string(r.id) : ""; }

// "1.2e+03", "-" where nothing ran.
std::string times(double effect) { return std::isfinite(effect) ? fmt::format("{:.3g}", effect) : "-"; }

// The channel that shows the row best, at the end that moves more.
std::string shown_best(const Sensitivity& s, const DrivenRow& r) {
  const DrivenEnd& end = r.ends[0].effect > r.ends[1].effect || std::isnan(r.ends[1].effect) ? r.ends[0] : r.ends[1];
  std::size_t best = s.channels.size();
  for (std::size_t c = 0; c < end.by_channel.size(); ++c)
    if (end.by_channel[c] > 0 && (best == s.channels.size() || end.by_channel[c] > end.by_channel[best])) best = c;
  return best < s.channels.size() ? words(std::string(info(s.channels[best]).name)) : "nothing";
}

// "fails at its minimum on h01.csv"; empty where all ran.
std::string failures_of(const DrivenRow& r) {
  std::vector<std::string> said;
  for (const std::size_t end : {0, 1}) {
    std::vector<std::string> names;
    for (const std::string& path : r.ends[end].failed) names.push_back(file_name(path));
    if (!names.empty())
      said.push_back(fmt::format("fails at its {} on {}", end == 0 ? "minimum" : "maximum", join(names)));
  }
  return join(said, "; ");
}

std::string note_of(const Sensitivity& s, const DrivenRow& r) {
  const std::string failures = failures_of(r), held = r.estimate ? "" : "held in a tune, ";
  return held + "shown best by " + shown_best(s, r) + (failures.empty() ? "" : "; " + failures);
}

std::size_t rows_that_fail(const Sensitivity& s) {
  return static_cast<std::size_t>(
      std::count_if(s.rows.begin(), s.rows.end(), [](const DrivenRow& r) { return !failures_of(r).empty(); }));
}

std::string strongest(const Sensitivity& s) {
  std::vector<std::string> names;
  for (std::size_t j = 0; j < std::min<std::size_t>(3, s.rows.size()); ++j) names.push_back(words(s.rows[j].name));
  return join(names);
}

constexpr const char* lead =
    "Each row alone at its minimum and at its maximum. Effect: rms change of the simulated signals, in times their "
    "sensors' noise.";

}  // namespace

std::string text_of(const Sensitivity& s) {
  std::string text = std::string(lead) + "\n";
  Columns table("rrllrrrrl", 2);
  table.row({"", "id", "row", "tune", "minimum", "effect", "maximum", "effect", "shown best by"});
  for (std::size_t j = 0; j < s.rows.size(); ++j) {
    const DrivenRow& r = s.rows[j];
    const HandyUnit unit = handy_unit(r.unit, std::max(std::abs(r.ends[0].value), std::abs(r.ends[1].value)));
    const auto value = [&](const DrivenEnd& e) {
      return digits(e.value * unit.factor) + (unit.name.empty() ? "" : " " + unit.name);
    };
    table.row({std::to_string(j + 1), id_of(r), r.name, r.estimate ? "free" : "held", value(r.ends[0]),
               times(r.ends[0].effect), value(r.ends[1]), times(r.ends[1].effect), shown_best(s, r)});
  }
  text += table.text();
  for (const DrivenRow& r : s.rows)
    if (const std::string failures = failures_of(r); !failures.empty()) text += r.name + " " + failures + "\n";
  if (s.interrupted) text += "interrupted: not all logs are in it\n";
  return text;
}

Json sensitivity_json(const Sensitivity& s) {
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  const auto end_json = [&](const DrivenEnd& end) {
    Json channels = Json::object();
    for (std::size_t c = 0; c < s.channels.size(); ++c)
      channels[std::string(info(s.channels[c]).name)] = number(end.by_channel[c]);
    return Json{{"value", end.value}, {"effect", number(end.effect)}, {"channels", channels}, {"failed", end.failed}};
  };
  Json rows = Json::array();
  for (std::size_t j = 0; j < s.rows.size(); ++j) {
    const DrivenRow& r = s.rows[j];
    rows.push_back({{"rank", j + 1},
                    {"id", r.id > 0 ? Json(r.id) : Json(nullptr)},
                    {"name", r.name},
                    {"unit", r.unit},
                    {"estimate", r.estimate},
                    {"nominal", r.nominal},
                    {"effect", number(r.largest())},
                    {"at_lower", end_json(r.ends[0])},
                    {"at_upper", end_json(r.ends[1])}});
  }
  return {{"rows", rows}, {"interrupted", s.interrupted}};
}

Page sensitivity_page(const Header& header, const Sensitivity& s) {
  Page page(header, "Sensitivity of the simulation to every row");
  Verdict v;
  v.headline = "Strongest rows: " + strongest(s);
  v.detail = lead;
  v.facts = {{"Rows driven", std::to_string(s.rows.size())},
             {"Rows where a run fails", std::to_string(rows_that_fail(s))},
             {"Simulations", std::to_string(s.simulations)}};
  if (s.interrupted) v.reasons.push_back("Interrupted: not all logs are in it.");
  page.verdict(v);
  page.section("Each row at its minimum and maximum",
               "To the left the minimum, to the right the maximum; bars by the logarithm of 1 + effect. One row at a "
               "time: what two rows do together is not seen.");
  Tornado tornado{.title = "Effect of each row", .label = "row", .unit = "times the noise", .rows = {}};
  tornado.shown = rows_shown;
  for (const DrivenRow& r : s.rows)
    tornado.rows.push_back({(r.id > 0 ? id_of(r) + " " : "") + words(r.name),
                            {r.ends[0].effect, r.ends[1].effect},
                            {times(r.ends[0].effect), times(r.ends[1].effect)},
                            note_of(s, r)});
  page.add(tornado);
  page.section("Channel by channel", "The larger of both ends, in times the sensor's noise.", true);
  TablePart table{"Effect by channel", "l", {"row"}, {}, 0};
  for (const Signal signal : s.channels) {
    table.alignment += 'r';
    table.head.push_back(words(std::string(info(signal).name)));
  }
  for (const DrivenRow& r : s.rows) {
    std::vector<Cell> cells = {words(r.name)};
    for (std::size_t c = 0; c < s.channels.size(); ++c) {
      const double effect = std::fmax(r.ends[0].by_channel[c], r.ends[1].by_channel[c]);
      cells.emplace_back(times(effect), effect);
    }
    table.rows.push_back(std::move(cells));
  }
  page.add(table);
  return page;
}

}  // namespace servodx::report
