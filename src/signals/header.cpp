#include "signals/header.h"

#include <algorithm>
#include <cctype>
#include <cstddef>
#include <optional>

#include "base/error.h"
#include "base/trimmed.h"
#include "base/units.h"
#include "signals/guess.h"
#include "signals/time_stamp.h"

namespace servodx {
namespace {

constexpr std::size_t most_lines = 200;  // above a header

constexpr std::string_view blanks = " \t\r";

std::vector<std::string> cells_of(std::string_view line, char separator) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  std::vector<std::string> cells;
  for (bool more = true; more;) {
    bool quoted = false;
    std::size_t end = 0;
    for (; end < line.size() && (quoted || line[end] != separator); ++end) quoted ^= line[end] == '"';
    std::string_view cell = trimmed(line.substr(0, end), blanks);
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.emplace_back(cell);
    more = end < line.size();
    line.remove_prefix(std::min(end + 1, line.size()));
  }
  return cells;
}

bool is_number(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return parse_number(cell).has_value();
}

bool is_sample(const std::string& cell) { return is_number(cell) || parse_time_stamp(cell) || is_date(cell); }

struct NumbersRow {
  char separator;
  std::size_t width;
};

std::optional<NumbersRow> numbers_of(std::string_view line) {
  for (const char separator : {';', '\t', ','}) {
    if (line.find(separator) == line.npos) continue;
    const std::vector<std::string> cells = cells_of(line, separator);
    long samples = 0, others = 0;
    for (const std::string& cell : cells) (is_sample(cell) ? samples : others) += !cell.empty();
    if (others == 0 && samples > 1) return NumbersRow{separator, cells.size()};
  }
  return std::nullopt;
}

bool equal_but_for_capitals(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x)) == std::tolower(static_cast<unsigned char>(y));
  });
}

// The cells without their brackets, where one at least is a unit and none a number.
std::vector<std::string> as_units(std::vector<std::string> units) {
  bool any = false;
  for (std::string& cell : units) {
    if (is_number(cell)) return {};
    const std::size_t n = cell.size();
    if (n > 1 && ((cell[0] == '[' && cell[n - 1] == ']') || (cell[0] == '(' && cell[n - 1] == ')')))
      cell = trimmed(std::string_view(cell).substr(1, n - 2), blanks);
    any = any || !unit_meant(cell).empty();
  }
  return any ? units : std::vector<std::string>{};
}

// Rows above the first of numbers, not blank and no comments; the first is the one that the cursor took.
struct Above {
  struct Line {
    std::size_t at;  // [byte] ahead of the cursor
    std::string_view text;
  };
  std::vector<Line> lines;
  std::optional<NumbersRow> numbers;
  long numbers_line = 0;
};

Above look_ahead(const CsvCursor& csv) {
  Above above;
  const std::string_view text = csv.ahead();
  long line_number = csv.header_line();
  for (std::size_t at = 0; at < text.size() && above.lines.size() < most_lines && !above.numbers;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = text.substr(at, end - at);
    ++line_number;
    if (!trimmed(line, blanks).empty() && !line.starts_with('#')) {
      above.numbers = numbers_of(line);
      if (above.numbers)
        above.numbers_line = line_number;
      else
        above.lines.push_back({at, line});
    }
    at = end + 1;
  }
  return above;
}

// "Name  x  Name  y": each signal with a time of its own, as TwinCAT's Scope writes it.
bool are_pairs(const std::vector<std::string>& cells) {
  if (cells.size() < 4 || cells.size() % 2 != 0 || cells[0].empty()) return false;
  for (std::size_t k = 2; k < cells.size(); k += 2)
    if (cells[k] != cells[0]) return false;
  return cells[1] != cells[0];
}

}  // namespace

bool ends_with_comment(const std::vector<std::string>& header) {
  return header.size() > 2 &&
         (equal_but_for_capitals(header.back(), "comment") || equal_but_for_capitals(header.back(), "kommentar"));
}

bool is_row_of_numbers(std::string_view line) { return numbers_of(line).has_value(); }

std::vector<std::string> units_row(CsvCursor& csv) {
  std::vector<std::string> units = as_units(csv.row_ahead());
  if (ends_with_comment(csv.header()) && units.size() + 1 == csv.header().size()) units.emplace_back();
  return units.size() == csv.header().size() ? units : std::vector<std::string>{};
}

std::vector<std::string> units_above(std::string_view text, const CsvCursor& csv) {
  constexpr std::string_view label = "\nY_Unit_Label";
  const std::size_t at = text.find(label);
  if (at == text.npos || std::count(text.begin(), text.begin() + static_cast<long>(at), '\n') > csv.header_line())
    return {};
  std::vector<std::string> units =
      as_units(cells_of(text.substr(at + 1, text.find('\n', at + 1) - at - 1), csv.separator()));
  if (ends_with_comment(csv.header()) && units.size() + 1 == csv.header().size()) units.emplace_back();
  if (units.size() != csv.header().size()) return {};
  units.front() = "s";
  return units;
}

void require_names(const CsvCursor& csv, const std::string& path) {
  const auto& header = csv.header();
  if (header.size() > 1 && std::all_of(header.begin(), header.end(), is_sample))
    throw InputError({path, csv.header_line(), ""}, "there is no header row: the first row is numbers",
                     "write a row of 'name [unit]' above it");
}

long pass_lines_above_header(CsvCursor& csv, const std::string& path) {
  const Above above = look_ahead(csv);
  if (!above.numbers) return 0;
  const auto [separator, width] = *above.numbers;
  const auto fits = [width = width](const std::vector<std::string>& cells) {
    return cells.size() == width || (cells.size() == width + 1 && ends_with_comment(cells));
  };
  if (fits(csv.header()) || above.lines.empty()) return 0;
  const auto cells_at = [&, separator = separator](std::size_t k) { return cells_of(above.lines[k].text, separator); };
  std::size_t last = above.lines.size() - 1;
  for (std::size_t k = 0; k <= last; ++k)
    if (const auto cells = cells_at(k); cells.size() == width && are_pairs(cells))
      throw InputError({path, above.numbers_line, ""},
                       "its columns go in pairs, a time and a value each: every signal has a time of its own",
                       "export with one time column for all signals, or delete all but the first time column and "
                       "write a row of 'name [unit]' above the numbers");
  if (!fits(cells_at(last))) return 0;
  if (last > 0 && fits(cells_at(last - 1)) && !as_units(cells_at(last)).empty()) --last;
  csv.header_at(above.lines[last].at, separator);
  return static_cast<long>(last) + 1;
}

}  // namespace servodx
