#include "store/history_csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string_view>
#include <tuple>

#include "base/celsius.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/reading_limits.h"
#include "base/units.h"
#include "model/state.h"
#include "parameters/list.h"
#include "prognose/check.h"
#include "prognose/check_name.h"
#include "prognose/constants.h"
#include "prognose/oil_temperature.h"
#include "prognose/valve_history.h"
#include "servodx/history.h"
#include "simulate/scenario.h"

namespace servodx {

using namespace prognose_constants;

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

// A number that is not below nought.
double counted(const Cells& cells, Column c, const Place& row, bool required) {
  const double x = parsed(cells, c, row, required);
  if (x < 0) throw InputError({row.file, row.line, header[c]}, "'" + cells[c] + "' is below 0", "mend the number");
  return x;
}

// The row of `parameter:ID`; none for other names.
const ParameterInfo* row_of(const Cells& cells, const Place& row) {
  constexpr std::string_view start = "parameter:";
  if (!cells[figure].starts_with(start)) return nullptr;
  const auto id = parse_number(std::string_view(cells[figure]).substr(start.size()));
  if (!id || *id != std::floor(*id) || *id < 1 || *id > n_parameters)
    throw InputError({row.file, row.line, header[figure]}, "'" + cells[figure] + "' is no row of the table",
                     fmt::format("use parameter:1 to parameter:{}", n_parameters));
  return &parameter_list[static_cast<std::size_t>(*id) - 1];
}

// The unit in which a history keeps a figure; empty for figures it does not know.
std::string kept_in(const Cells& cells, const Place& row) {
  if (const ParameterInfo* parameter = row_of(cells, row)) return std::string(parameter->unit);
  switch (CheckName(cells[figure]).kind()) {
    case CheckKind::mean_error:
      return "m";
    case CheckKind::fidelity:
      return "1";
    case CheckKind::correlation:
      return "m2";
    default:
      return "";
  }
}

// Factor from the row's unit to the kept one.
double to_kept(const Cells& cells, const std::string& kept, const Place& row) {
  const std::string& written = cells[unit];
  const auto plain = [](const std::string& u) { return u == "-" || u == "1"; };
  if (kept.empty() || written.empty() || written == kept || (plain(written) && plain(kept))) return 1;
  const Unit *from = find_unit(written), *to = find_unit(kept);
  if (!from || !to || from->dimension != to->dimension)
    throw InputError({row.file, row.line, header[unit]}, fmt::format("'{}' is no unit of {}", written, cells[figure]),
                     "use " + (to ? units_of(to->dimension) : kept));
  return from->scale() / to->scale();
}

Recording recording_of(const Cells& cells, double hours, bool celsius, const Place& row) {
  Recording r;
  r.at = hours;
  const double cycled = counted(cells, cycles, row, false);
  if (!std::isnan(cycled)) r.cycles = cycled;
  r.temperature = parsed(cells, temperature, row, false) + (celsius ? zero_celsius : 0.0);
  r.temperature_source = cells[temperature_source];
  if (std::isnan(r.temperature))
    r.temperature = reference_oil_temperature, r.temperature_source = name_of(OilSource::assumed);
  if (r.temperature < coldest_oil || r.temperature > hottest_oil)
    throw InputError({row.file, row.line, celsius ? "oil_temperature [degC]" : header[temperature]},
                     "'" + cells[temperature] + "' is no oil's temperature",
                     celsius ? "give degrees Celsius from -100 to 300" : "give kelvins from 173 to 573");
  r.log = cells[log], r.log_sha256 = cells[log_sha256];
  r.table_sha256 = cells[table_sha256], r.version = cells[version], r.recorded_at = cells[recorded_at];
  return r;
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
        cells[figure] = c.name.text(), cells[value] = number(c.value), cells[std_error] = number(c.std_error);
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
  const std::string bytes = read_file_within(path, largest_history);
  CsvCursor cursor(bytes, path);
  bool celsius = false;
  const std::vector<int> columns = columns_of(cursor, path, celsius);
  HistoryContent content;
  std::map<std::string, std::size_t> place;  // of a valve
  // Of a check among its valve's: rows of one check need not stand together.
  std::map<std::tuple<std::size_t, double, std::string, std::string>, std::size_t> checked;
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
    for (const auto& [column, which] : {std::pair("valve", valve), std::pair("serial", serial)})
      if (cells[which].size() > longest_name)
        throw InputError({path, row.line, column}, fmt::format("has more than {} bytes", longest_name), "shorten it");
    const auto [found, fresh] = place.emplace(cells[valve], content.valves.size());
    if (fresh) content.valves.push_back({cells[valve], cells[serial], {}, {}, {}});
    ValveHistory& v = content.valves[found->second];
    const double hours = counted(cells, at, row, true);
    if (cells[kind] == "event") {
      const auto known = find_event(cells[figure]);
      if (!known)
        throw InputError({path, row.line, "name"}, "unknown event '" + cells[figure] + "'", "use " + event_names());
      v.events.push_back({hours, *known, cells[text], cells[recorded_at]});
      continue;
    }
    const auto [check, first] =
        checked.emplace(std::tuple(found->second, hours, cells[log_sha256], cells[table_sha256]), v.recordings.size());
    if (first) v.recordings.push_back(recording_of(cells, hours, celsius, row));
    if (cells[figure].empty()) {  // of a check that holds no figure
      if (!cells[value].empty())
        throw InputError({path, row.line, header[figure]}, "is empty beside a value", "name the figure");
      continue;
    }
    std::vector<Check>& checks = v.recordings[check->second].checks;
    if (std::any_of(checks.begin(), checks.end(), [&](const Check& c) { return c.name.text() == cells[figure]; }))
      throw InputError({path, row.line, "name"}, "'" + cells[figure] + "' stands twice in one check", "remove one");
    const std::string kept = kept_in(cells, row);
    const double factor = to_kept(cells, kept, row);
    Check c{cells[figure],
            factor * parsed(cells, value, row, false),
            factor * counted(cells, std_error, row, false),
            kept.empty() ? cells[unit] : kept,
            factor * parsed(cells, measured, row, false),
            parsed(cells, expected, row, false),
            cells[cause]};
    if (std::isnan(c.expected)) c.expected = 1;
    if (std::isnan(c.measured)) c.measured = c.value * c.expected;
    checks.push_back(std::move(c));
  }
  return content;
}

}  // namespace servodx
