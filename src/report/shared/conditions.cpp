#include "report/shared/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/celsius.h"
#include "report/shared/columns.h"
#include "report/shared/handy.h"
#include "report/shared/page_head.h"
#include "report/shared/parts.h"
#include "servodx/log.h"
#include "store/baseline_keys.h"

namespace servodx::report {
namespace {

struct Words {
  const char *name, *unit;
};
constexpr std::array<Words, n_conditions> words_of = {
    {{"supply", "Pa"}, {"return", "Pa"}, {"oil", "K"}, {"load up to", "N"}, {"drive up to", "A"}}};
const Words& of(Condition c) { return words_of[static_cast<std::size_t>(c)]; }

std::string size(Condition c, const std::optional<double>& x) {
  if (!x) return "-";
  return c == Condition::oil ? fmt::format("{} degC", std::lround(*x - zero_celsius)) : handy(*x, of(c).unit);
}

std::string range(Condition c, const std::optional<double>& lowest, const std::optional<double>& highest) {
  if (!lowest) return "-";
  const std::string from = size(c, lowest), to = size(c, highest);
  return from == to ? from : from + " to " + to;
}

std::string range(const ConditionRow& row) { return range(row.of, row.lowest, row.highest); }
std::string tuned_range(const ConditionRow& row) { return range(row.of, row.tuned_lowest, row.tuned_highest); }

bool are_tuned_known(const std::vector<ConditionRow>& rows) {
  return std::any_of(rows.begin(), rows.end(), [](const ConditionRow& r) { return r.tuned_lowest.has_value(); });
}

// What a condition is beyond.
std::string known_of(const ConditionRow& r) {
  if (r.lowest) return "fault-free logs " + range(r);
  return r.tuned_lowest ? "tuning logs " + tuned_range(r) : "sheet " + size(r.of, r.sheet);
}

}  // namespace

std::string conditions_in_words(const std::vector<ConditionRow>& rows) {
  std::vector<std::string> out;
  for (const ConditionRow& r : rows)
    if (r.value) out.push_back(std::string(of(r.of).name) + " " + size(r.of, r.value));
  return join(out);
}

std::string beyond_in_words(const std::vector<ConditionRow>& rows) {
  std::vector<std::string> out;
  for (const ConditionRow& r : rows)
    if (r.beyond) out.push_back(fmt::format("{} {} ({})", of(r.of).name, size(r.of, r.value), known_of(r)));
  return join(out);
}

std::string tuned_in_words(const std::vector<ConditionRow>& rows) {
  std::vector<std::string> out;
  for (const ConditionRow& r : rows)
    if (r.tuned_lowest) out.push_back(std::string(of(r.of).name) + " " + tuned_range(r));
  return join(out);
}

Json conditions_json(const std::vector<ConditionRow>& rows) {
  Json out = Json::array();
  const auto value = [](const std::optional<double>& x) { return x ? number(*x) : Json(nullptr); };
  for (const ConditionRow& r : rows)
    out.push_back({{"condition", store::key_of(r.of)},
                   {"unit", of(r.of).unit},
                   {"value", value(r.value)},
                   {"sheet", value(r.sheet)},
                   {"lowest", value(r.lowest)},
                   {"highest", value(r.highest)},
                   {"tuned_lowest", value(r.tuned_lowest)},
                   {"tuned_highest", value(r.tuned_highest)},
                   {"beyond", r.beyond}});
  return out;
}

void add_conditions(Page& page, const std::vector<ConditionRow>& rows) {
  if (rows.empty()) return;
  const bool tuned = are_tuned_known(rows);
  TablePart table{
      "Where it was recorded", "lllll", {"condition", "this log", "data sheet", "fault-free logs", ""}, {}, 0};
  if (tuned) table.alignment += "l", table.head.insert(table.head.end() - 1, "logs that tuned");
  for (const ConditionRow& r : rows) {
    table.rows.push_back({of(r.of).name, size(r.of, r.value), size(r.of, r.sheet), range(r), r.beyond ? "beyond" : ""});
    if (tuned) table.rows.back().insert(table.rows.back().end() - 1, Cell(tuned_range(r)));
  }
  page.add(table);
}

std::vector<ConditionFigure> condition_figures(const std::vector<ConditionRow>& rows) {
  constexpr std::array<std::optional<Signal>, n_conditions> signals = {
      Signal::supply_pressure, Signal::return_pressure, Signal::oil_temperature, Signal::load_force, std::nullopt};
  std::vector<ConditionFigure> out;
  for (const ConditionRow& r : rows)
    if (r.value) out.push_back({of(r.of).name, size(r.of, r.value), signals[static_cast<std::size_t>(r.of)]});
  return out;
}

void add_to_head(PageHead& head, const std::vector<Log>& logs) {
  for (const auto& [condition, name] : {std::pair(Condition::oil, "Oil"), std::pair(Condition::supply, "Supply")}) {
    std::optional<double> lowest, highest;
    for (const Log& log : logs) {
      const std::optional<double> value = operating_point_of(log)[static_cast<std::size_t>(condition)];
      if (!value) continue;
      lowest = std::min(lowest.value_or(*value), *value);
      highest = std::max(highest.value_or(*value), *value);
    }
    if (lowest) head.say(name, range(condition, lowest, highest));
  }
}

void add_to_head(Page& page, const std::vector<ConditionRow>& rows) {
  for (const ConditionRow& r : rows) {
    if (!r.value) continue;
    if (r.of == Condition::oil) page.head("Oil", size(r.of, r.value));
    if (r.of == Condition::supply) page.head("Supply", size(r.of, r.value));
  }
}

}  // namespace servodx::report
