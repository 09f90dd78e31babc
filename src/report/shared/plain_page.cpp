#include "report/shared/plain_page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "report/shared/handy.h"
#include "report/shared/json.h"
#include "report/shared/parts.h"
#include "report/shared/replay_part.h"
#include "servodx/log.h"

namespace servodx::report {
namespace {

constexpr std::size_t rows_shown = 50;

Cell cell_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_integer()) return Cell(value.dump(), value.get<double>());
  if (value.is_number()) return Cell(digits(value.get<double>(), 4), value.get<double>());
  if (value.is_null()) return "";
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

TablePart table_of(const std::string& title, const Json& array) {
  TablePart table{words(title), "", {}, {}, rows_shown};
  for (const Json& item : array)
    for (const auto& [key, value] : item.items())
      if (std::find(table.head.begin(), table.head.end(), key) == table.head.end()) {
        table.head.push_back(key);
        table.alignment += value.is_number() ? 'r' : 'l';
      }
  for (const Json& item : array) {
    std::vector<Cell> row;
    for (const std::string& key : table.head) row.push_back(item.contains(key) ? cell_of(item[key]) : Cell(""));
    table.rows.push_back(std::move(row));
  }
  for (std::string& name : table.head) name = words(name);
  return table;
}

}  // namespace

Page plain_page(const Header& header, const std::string& text, const Json& body) {
  Page page(header, "Result of " + header.command);
  Verdict v;
  v.headline = text.substr(0, text.find('\n'));
  page.verdict(v);
  page.section("Result");
  TablePart single{"Figures", "lr", {"", ""}, {}, rows_shown};
  for (const auto& [key, value] : body.items())
    if (!value.is_array() && !value.is_object()) single.rows.push_back({words(key), cell_of(value)});
  if (!single.rows.empty()) page.add(single);
  for (const auto& [key, value] : body.items()) {
    if (value.is_object())
      page.add(table_of(key, Json::array({value})));
    else if (value.is_array() && !value.empty() && value.front().is_object())
      page.add(table_of(key, value));
  }
  return page;
}

Page columns_page(const Header& header, const std::string& headline, const std::vector<OutputColumn>& columns) {
  Page page(header, headline);
  Verdict v;
  v.headline = headline;
  page.verdict(v);
  page.section("Signals");
  const auto scaled = [](const OutputColumn& c) {
    const Unit* unit = find_unit(c.unit);
    const double full = c.full_scale > 0 ? c.full_scale : 1.0;
    std::vector<double> y = c.value;
    if (unit)
      for (double& value : y) value = unit->from_si(value / full);
    return y;
  };
  const std::vector<double> time = columns.empty() ? std::vector<double>{} : columns.front().value;
  for (const OutputColumn& c : columns) {
    if (c.signal == Signal::time) continue;
    const std::string name = words(std::string(info(c.signal).name));
    Plot plot{.title = name + " [" + c.unit + "]",
              .x_label = "time [s]",
              .x = time,
              .group = "log",
              .low = true,
              .most_rows = 6000};
    plot.series.push_back({name, scaled(c), c.signal == Signal::command ? Role::input : Role::measured});
    page.add(plot);
  }
  return page;
}

}  // namespace servodx::report
