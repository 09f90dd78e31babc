#include "prognose/history_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "base/csv.h"
#include "base/error.h"
#include "base/units.h"

namespace servodx {
namespace {

enum Column {
  kind,
  valve,
  serial,
  at,
  cycles,
  figure,
  value,
  std_error,
  unit,
  measured,
  expected,
  cause,
  temperature,
  temperature_source,
  log,
  log_sha256,
  table_sha256,
  version,
  recorded_at,
  text,
  n_columns
};
constexpr std::array<const char*, n_columns> header = {"kind",
                                                       "valve",
                                                       "serial",
                                                       "at [h]",
                                                       "cycles",
                                                       "name",
                                                       "value",
                                                       "std_error",
                                                       "unit",
                                                       "measured",
                                                       "expected",
                                                       "cause",
                                                       "oil_temperature [K]",
                                                       "temperature_source",
                                                       "log",
                                                       "log_sha256",
                                                       "table_sha256",
                                                       "version",
                                                       "recorded_at",
                                                       "text"};
using Cells = std::array<std::string, n_columns>;

std::string number(double x) {
  std::string s;
  if (std::isfinite(x)) append_number(s, x);
  return s;
}

void append_row(std::string& to, const Cells& cells) {
  for (int c = 0; c < n_columns; ++c) {
    if (c > 0) to += ',';
    append_cell(to, cells[static_cast<std::size_t>(c)]);
  }
  to += '\n';
}

double parsed(const Cells& cells, Column c, const Place& row, bool required) {
  const std::string& cell = cells[c];
  const Place where{row.file, row.line, header[c]};
  if (cell.empty()) {
    if (required) throw InputError(where, "is empty", "give a number");
    return std::nan("");
  }
  const auto x = parse_number(cell);
  if (!x) throw InputError(where, "'" + cell + "' is not a number", "write it with a point, without a unit");
  return *x;
}

// Place of each of the file's columns among ours.
std::vector<int> columns_of(const CsvCursor& cursor, const std::string& path, bool& celsius) {
  std::vector<int> columns;
  for (const std::string& name : cursor.header()) {
    const bool warm = name == "oil_temperature [degC]";
    const auto found = warm ? header.begin() + temperature : std::find(header.begin(), header.end(), name);
    const int c = static_cast<int>(found - header.begin());
    std::string known;
    for (const char* n : header) known += (known.empty() ? "" : ", ") + std::string(n);
    if (found == header.end())
      throw InputError({path, cursor.header_line(), name}, "is no column of a history",
                       "leave it out; a history has " + known);
    if (std::find(columns.begin(), columns.end(), c) != columns.end())
      throw InputError({path, cursor.header_line(), name}, "is there twice", "remove one");
    celsius = celsius || warm;
    columns.push_back(c);
  }
  for (const Column c : {valve, at, figure, value})
    if (std::find(columns.begin(), columns.end(), c) == columns.end())
      throw InputError({path, cursor.header_line(), header[c]}, "a history needs this column",
                       "'servodx history export' shows what one looks like");
  return columns;
}

}  // namespace

std::string history_csv(const HistoryContent& content) {
  std::string out;
  Cells names;
  std::copy(header.begin(), header.end(), names.begin());
  append_row(out, names);
  for (const auto& [sha256, body] : content.tables) {
    Cells cells;
    cells[kind] = "table", cells[table_sha256] = sha256, cells[text] = body;
    append_row(out, cells);
  }
  for (const ValveHistory& v : content.valves) {
    for (const Recording& r : v.recordings) {
      Cells cells;
      cells[kind] = "figure", cells[valve] = v.valve, cells[serial] = v.serial, cells[at] = number(r.at);
      cells[cycles] = number(r.cycles.value_or(std::nan(""))), cells[temperature] = number(r.temperature);
      cells[temperature_source] = r.temperature_source, cells[log] = r.log, cells[log_sha256] = r.log_sha256;
      cells[table_sha256] = r.table_sha256, cells[version] = r.version, cells[recorded_at] = r.recorded_at;
      if (r.checks.empty()) append_row(out, cells);
      for (const Check& c : r.checks) {
        cells[figure] = c.name, cells[value] = number(c.value), cells[std_error] = number(c.std_error);
        cells[unit] = c.unit, cells[measured] = number(c.measured), cells[expected] = number(c.expected),
        cells[cause] = c.cause;
        append_row(out, cells);
      }
    }
    for (const Event& e : v.events) {
      Cells cells;
      cells[kind] = "event", cells[valve] = v.valve, cells[serial] = v.serial, cells[at] = number(e.at);
      cells[figure] = name_of(e.kind), cells[recorded_at] = e.recorded_at, cells[text] = e.text;
      append_row(out, cells);
    }
  }
  return out;
}

HistoryContent read_history_csv(const std::string& path) {
  const std::string bytes = read_file(path);
  CsvCursor cursor(bytes, path);
  bool celsius = false;
  const std::vector<int> columns = columns_of(cursor, path, celsius);
  HistoryContent content;
  std::map<std::string, std::size_t> place;  // of a valve
  while (cursor.next_row()) {
    Cells cells;
    std::size_t n = 0;
    std::string cell;
    while (cursor.next_cell(cell)) {
      if (n < columns.size()) cells[static_cast<std::size_t>(columns[n])] = cell;
      ++n;
    }
    const Place row{path, cursor.line(), ""};
    if (n != columns.size())
      throw InputError(row, fmt::format("has {} cells, the header {}", n, columns.size()), "mend the row");
    if (cells[kind].empty()) cells[kind] = "figure";
    if (cells[kind] == "table") {
      content.tables.emplace_back(cells[table_sha256], cells[text]);
      continue;
    }
    if (cells[kind] != "figure" && cells[kind] != "event")
      throw InputError({path, row.line, "kind"}, "unknown '" + cells[kind] + "'", "use figure, event or table");
    if (cells[valve].empty()) throw InputError({path, row.line, "valve"}, "is empty", "name the valve");
    const auto [found, fresh] = place.emplace(cells[valve], content.valves.size());
    if (fresh) content.valves.push_back({cells[valve], cells[serial], {}, {}, {}});
    ValveHistory& v = content.valves[found->second];
    const double hours = parsed(cells, at, row, true);
    if (cells[kind] == "event") {
      const auto known = find_event(cells[figure]);
      if (!known)
        throw InputError({path, row.line, "name"}, "unknown event '" + cells[figure] + "'", "use " + event_names());
      v.events.push_back({hours, *known, cells[text], cells[recorded_at]});
      continue;
    }
    if (v.recordings.empty() || v.recordings.back().at != hours ||
        v.recordings.back().log_sha256 != cells[log_sha256] ||
        v.recordings.back().table_sha256 != cells[table_sha256]) {
      Recording r;
      r.at = hours;
      const double counted = parsed(cells, cycles, row, false);
      if (!std::isnan(counted)) r.cycles = counted;
      r.temperature = parsed(cells, temperature, row, false) + (celsius ? 273.15 : 0.0);
      r.temperature_source = cells[temperature_source];
      if (std::isnan(r.temperature)) r.temperature = 313.15, r.temperature_source = "assumed";
      r.log = cells[log], r.log_sha256 = cells[log_sha256];
      r.table_sha256 = cells[table_sha256], r.version = cells[version], r.recorded_at = cells[recorded_at];
      v.recordings.push_back(std::move(r));
    }
    if (cells[figure].empty()) continue;
    std::vector<Check>& checks = v.recordings.back().checks;
    if (std::any_of(checks.begin(), checks.end(), [&](const Check& c) { return c.name == cells[figure]; }))
      throw InputError({path, row.line, "name"}, "'" + cells[figure] + "' stands twice in one check", "remove one");
    Check c{cells[figure], parsed(cells, value, row, false),    parsed(cells, std_error, row, false),
            cells[unit],   parsed(cells, measured, row, false), parsed(cells, expected, row, false),
            cells[cause]};
    if (std::isnan(c.expected)) c.expected = 1;
    if (std::isnan(c.measured)) c.measured = c.value * c.expected;
    checks.push_back(std::move(c));
  }
  return content;
}

}  // namespace servodx
