#include "fleet/check_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iostream>
#include <iterator>
#include <utility>

#include "base/csv.h"
#include "base/error.h"
#include "base/units.h"
#include "fleet/log_list.h"

namespace servodx {
namespace {

enum Column { log, valve, hours, cycles, serial, params, n_columns };
constexpr std::array<const char*, n_columns> names = {"log", "valve", "hours", "cycles", "serial", "params"};
constexpr int n_needed = hours + 1;
constexpr int not_ours = -1;
constexpr const char* shape = "begin the list with the header log,valve,hours and write a row for each check";

using Cells = std::array<std::string, n_columns>;

std::string text_of_list(const std::string& path) {
  return is_standard_input(path) ? std::string(std::istreambuf_iterator<char>(std::cin), {}) : read_file(path);
}

// Place of each of the file's columns among ours.
std::vector<int> columns_of(const CsvCursor& cursor, const std::string& path, CheckList& list) {
  std::vector<int> columns;
  std::array<bool, n_columns> seen{};
  for (const std::string& name : cursor.header()) {
    int column = not_ours;
    for (int c = 0; c < n_columns; ++c)
      if (name == names[static_cast<std::size_t>(c)]) column = c;
    columns.push_back(column);
    if (column == not_ours) {
      list.passed_over.push_back(name);
      continue;
    }
    bool& there = seen[static_cast<std::size_t>(column)];
    if (there) throw InputError({path, cursor.header_line(), name}, "is there twice", "remove one");
    there = true;
  }
  for (int c = 0; c < n_needed; ++c)
    if (const auto at = static_cast<std::size_t>(c); !seen[at])
      throw InputError({path, cursor.header_line(), names[at]}, "a list of checks needs this column", shape);
  return columns;
}

// False: the row is a comment. Numbers get a decimal point.
bool read_cells(CsvCursor& cursor, const std::string& path, const std::vector<int>& columns, Cells& cells) {
  std::size_t n = 0;
  for (std::string cell; cursor.next_cell(cell); ++n) {
    if (n == 0 && cell.starts_with('#')) return false;
    if (n < columns.size() && columns[n] != not_ours) cells[static_cast<std::size_t>(columns[n])] = std::move(cell);
  }
  if (n != columns.size())
    throw InputError({path, cursor.line(), ""}, fmt::format("has {} cells, the header {}", n, columns.size()),
                     "mend the row");
  if (cursor.decimal_comma())
    for (const Column c : {hours, cycles}) std::replace(cells[c].begin(), cells[c].end(), ',', '.');
  return true;
}

const std::string& filled(const Cells& cells, Column c, const std::string& path, long line, const char* mend) {
  const std::string& cell = cells[static_cast<std::size_t>(c)];
  if (cell.empty()) throw InputError({path, line, names[static_cast<std::size_t>(c)]}, "is empty", mend);
  return cell;
}

double counted(const std::string& cell, Column c, const std::string& path, long line) {
  const auto value = parse_number(cell);
  if (!value || !std::isfinite(*value) || *value < 0)
    throw InputError({path, line, names[static_cast<std::size_t>(c)]},
                     "'" + cell + "' is not a number that is 0 or more", "write it like 1250.5, without a unit");
  return *value;
}

CheckRow row_of(const Cells& cells, const std::string& path, long line, const std::string& of_call) {
  CheckRow row;
  row.line = line;
  row.log = filled(cells, log, path, line, "name the log's file");
  row.valve = filled(cells, valve, path, line, "name the valve");
  row.hours = counted(filled(cells, hours, path, line, "write the hours of use"), hours, path, line);
  if (!cells[cycles].empty()) row.cycles = counted(cells[cycles], cycles, path, line);
  row.serial = cells[serial];
  row.params = cells[params].empty() ? of_call : cells[params];
  if (row.params.empty())
    throw InputError({path, line, names[params]}, "the row has no tuned table, and --params names none",
                     "add --params TUNED, or name the valve's table in each row");
  return row;
}

}  // namespace

CheckList read_check_list(const std::string& path, const std::string& of_call) {
  const std::string text = text_of_list(path);
  CsvCursor cursor(text, path);
  CheckList list;
  const std::vector<int> columns = columns_of(cursor, path, list);
  while (cursor.next_row()) {
    Cells cells;
    if (read_cells(cursor, path, columns, cells)) list.rows.push_back(row_of(cells, path, cursor.line(), of_call));
  }
  if (list.rows.empty()) throw InputError({path, 0, ""}, "the list names no log", shape);
  return list;
}

std::string use_of(const CheckRow& row) {
  std::string use = row.valve + "\n";
  append_number(use, row.hours);
  return use;
}

}  // namespace servodx
