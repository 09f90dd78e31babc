#include "signals/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/small_letters.h"
#include "base/trimmed.h"
#include "base/trouble.h"
#include "base/units.h"
#include "signals/guess.h"
#include "signals/time_stamp.h"

namespace servodx {
namespace {

constexpr std::size_t most_lines = 200;     // above a header
constexpr std::size_t fewest_numbered = 4;  // columns: three samples in a row may count up by chance
constexpr double leap_over_step = 10;       // from channel numbers to the first sample, per step after it: its noise
constexpr std::size_t most_judged = 20;     // rows above the numbers that may be the header, and cells of each

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

std::optional<double> number_of(std::string cell) {
  std::replace(cell.begin(), cell.end(), ',', '.');
  return parse_number(cell);
}

bool is_number(const std::string& cell) { return number_of(cell).has_value(); }

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

// What a recorder writes into the column of the time, beside the units of the others.
constexpr std::array<std::string_view, 4> labels_of_units = {"unit", "units", "einheit", "einheiten"};
constexpr std::array<std::string_view, 2> names_of_comments = {"comment", "kommentar"};
constexpr std::array<std::string_view, 2> no_number = {"nan", "-nan"};

template <std::size_t n>
bool is_one_of(const std::array<std::string_view, n>& words, const std::string& cell) {
  return std::find(words.begin(), words.end(), in_small_letters(cell)) != words.end();
}

bool is_unit_of_time(const std::string& cell) {
  const Unit* const unit = find_unit(unit_meant(cell));
  return unit && unit->dimension == Dimension::time;
}

// The cells without their brackets, where none is a number and more than half of those that are filled are units: an
// "A" alone is no ampere, but a chamber. Behind a unit of time two more are enough.
std::vector<std::string> as_units(std::vector<std::string> units) {
  long known = 0, filled = 0;
  for (std::string& cell : units) {
    if (is_number(cell)) return {};
    const std::size_t n = cell.size();
    if (n > 1 && ((cell[0] == '[' && cell[n - 1] == ']') || (cell[0] == '(' && cell[n - 1] == ')')))
      cell = trimmed(std::string_view(cell).substr(1, n - 2), blanks);
    if (is_one_of(labels_of_units, cell)) cell.clear();
    known += is_unit_as_written(cell);
    filled += !cell.empty();
  }
  const bool behind_time = !units.empty() && is_unit_of_time(units.front());
  return 2 * known > filled || (behind_time && known > 2) ? units : std::vector<std::string>{};
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
bool are_pairs(std::vector<std::string> cells) {
  if (ends_with_comment(cells)) cells.pop_back();
  if (cells.size() < 4 || cells.size() % 2 != 0 || cells[0].empty()) return false;
  for (std::size_t k = 2; k < cells.size(); k += 2)
    if (cells[k] != cells[0]) return false;
  return cells[1] != cells[0];
}

// How many names of signals a person would know among the cells, less those that are no name.
long known_names(std::vector<std::string> cells) {
  cells.resize(std::min(cells.size(), most_judged));
  const std::vector<ColumnGuess> guesses = guess_columns(cells);
  return std::count_if(guesses.begin(), guesses.end(), [](const ColumnGuess& g) { return g.signal && !g.weak; }) -
         std::count_if(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); });
}

bool has_letter(const std::string& cell) {
  return std::any_of(cell.begin(), cell.end(), [](unsigned char c) { return std::isalpha(c) || c >= 0x80; });
}

// No cell is a number, nor the NaN that a sample may be.
bool is_row_of_words(const std::vector<std::string>& cells) {
  return std::any_of(cells.begin(), cells.end(), has_letter) &&
         std::none_of(cells.begin(), cells.end(),
                      [](const std::string& c) { return is_sample(c) || is_one_of(no_number, c); });
}

// "Offset; 0; 0", "ScaleFactor; 1; 1": no samples, and nothing to be done where they change nothing.
bool is_row_of_scales(const std::vector<std::string>& cells, long line, const std::string& path) {
  constexpr std::pair<std::string_view, double> labels[] = {{"offset", 0}, {"scalefactor", 1}, {"scale", 1},
                                                            {"factor", 1}, {"faktor", 1},      {"gain", 1}};
  const std::string first = in_small_letters(cells.front());
  const auto known =
      std::find_if(std::begin(labels), std::end(labels), [&](const auto& l) { return l.first == first; });
  if (known == std::end(labels)) return false;
  for (const std::string& cell : cells)
    if (const auto number = number_of(cell); number && *number != known->second)
      throw InputError(
          {path, line, ""},
          fmt::format("the row '{}' below the header is not {} for all columns", cells.front(), known->second),
          "write it as gain or offset of these columns in the rig file, where the numbers are without it, "
          "and delete the row");
  return true;
}

// The numbers of the next rows, NaN where a cell is none.
std::vector<std::vector<double>> numbers_ahead(const CsvCursor& csv, std::size_t rows) {
  std::vector<std::vector<double>> numbers;
  const std::string_view text = csv.ahead();
  for (std::size_t at = 0; at < text.size() && numbers.size() < rows;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    numbers.emplace_back();
    for (const std::string& cell : cells_of(text.substr(at, end - at), csv.separator()))
      numbers.back().push_back(number_of(cell).value_or(std::nan("")));
    at = end + 1;
  }
  return numbers;
}

// "0; 1; 2; 3" or "1; 2; 3; 4".
bool counts_up(const std::vector<double>& row) {
  if (row.size() < fewest_numbered || !(row[0] == 0 || row[0] == 1)) return false;
  for (std::size_t c = 1; c < row.size(); ++c)
    if (row[c] != row[0] + static_cast<double>(c)) return false;
  return true;
}

// "0; 0; 0; 0", beside the time: but a log may begin at rest, and so most columns must leap from there, and stay.
bool leaps_from_one_value(const std::vector<std::vector<double>>& rows, std::size_t time) {
  std::size_t leaps = 0, others = 0;
  double value = -1;
  for (std::size_t c = 0; c < rows[0].size(); ++c) {
    if (c == time) continue;
    if (others == 0) value = rows[0][c];
    if (rows[0][c] != value || !(value == 0 || value == 1)) return false;
    ++others;
    leaps += std::abs(rows[1][c] - rows[0][c]) > leap_over_step * std::abs(rows[2][c] - rows[1][c]);
  }
  return leaps > 1 && 2 * leaps > others;
}

}  // namespace

bool begins_with_channel_numbers(const CsvCursor& csv, std::size_t time, const std::string& path) {
  const auto rows = numbers_ahead(csv, 3);
  if (rows.size() < 3 || rows[0].size() != rows[1].size() || rows[1].size() != rows[2].size()) return false;
  if (!(counts_up(rows[0]) && rows[1] != rows[0]) && !leaps_from_one_value(rows, time)) return false;
  if (time < rows[0].size() && rows[1][time] <= rows[0][time])
    throw InputError({path, csv.line(), ""}, "the first row of numbers is no sample: it numbers the channels",
                     "delete it");
  return true;
}

bool is_name_of_comments(const std::string& name) { return is_one_of(names_of_comments, name); }

bool ends_with_comment(const std::vector<std::string>& header) {
  return header.size() > 2 && is_name_of_comments(header.back());
}

bool is_row_of_numbers(std::string_view line) { return numbers_of(line).has_value(); }

std::vector<std::string> units_row(CsvCursor& csv) {
  std::vector<std::string> units = as_units(csv.row_ahead());
  if (ends_with_comment(csv.header()) && units.size() + 1 == csv.header().size()) units.emplace_back();
  return units.size() == csv.header().size() ? units : std::vector<std::string>{};
}

RowsBelow pass_rows_below_header(CsvCursor& csv, const std::string& path) {
  const Above above = look_ahead(csv);
  // Without a row of numbers ahead, units alone can be told from samples.
  const long rows = above.numbers ? static_cast<long>(above.lines.size()) : 1;
  RowsBelow below;
  for (below.in_row = csv.next_row(); below.in_row && below.passed < rows; below.in_row = csv.next_row()) {
    const std::vector<std::string> units = units_row(csv), cells = csv.row_ahead();
    if (!units.empty() && below.units.empty()) {
      below.units = units;
      below.units_at = below.passed;
    } else if (!above.numbers || cells.size() != csv.header().size() ||
               !(is_row_of_words(cells) || is_row_of_scales(cells, csv.line(), path))) {
      break;
    }
    ++below.passed;
  }
  return below;
}

void refuse_ragged(const CsvCursor& csv, std::size_t cells, const std::string& path) {
  throw DocumentedError(Trouble::row, {path, csv.line(), ""},
                        fmt::format("ragged row: {} cells, the header has {}", cells, csv.header().size()),
                        cells > csv.header().size() && csv.separator() == ','
                            ? "write one cell a column; a decimal comma needs ';' as separator"
                            : "write one cell a column");
}

void require_as_many_cells(const CsvCursor& csv, const std::vector<std::string>& row, const std::string& path) {
  const std::size_t cells = row.size(), names = csv.header().size();
  if (cells <= names || (cells == names + 1 && ends_with_comment(csv.header()))) return;
  const bool whole = std::all_of(row.begin(), row.end(), [](const std::string& c) { return c.find('.') == c.npos; });
  if (csv.separator() != ',' || cells == names + 1 || !whole) refuse_ragged(csv, cells, path);
  throw DocumentedError(
      Trouble::row, {path, csv.line(), ""},
      fmt::format("ragged row: {} cells, the header has {}: decimal commas between commas", cells, names),
      "export with ';' or tab between cells, or with decimal points");
}

void refuse_second_header(const CsvCursor& csv, bool is_header, const std::string& path) {
  constexpr std::string_view of_labview = "***End_of_Header***";
  const Above above = look_ahead(csv);
  for (const Above::Line& line : above.lines)
    is_header = is_header || line.text.starts_with(of_labview) || cells_of(line.text, csv.separator()) == csv.header();
  if (is_header)
    throw DocumentedError(Trouble::row, {path, csv.line(), ""}, "a second header: the file holds several recordings",
                          "cut it into a file for each");
}

std::vector<std::string> units_above(std::string_view text, const CsvCursor& csv) {
  constexpr std::string_view label = "\nY_Unit_Label";
  const std::size_t at = text.find(label);
  if (at == text.npos || std::count(text.begin(), text.begin() + static_cast<long>(at), '\n') > csv.header_line())
    return {};
  std::vector<std::string> cells = cells_of(text.substr(at + 1, text.find('\n', at + 1) - at - 1), csv.separator());
  cells.front().clear();  // the label
  std::vector<std::string> units = as_units(cells);
  if (ends_with_comment(csv.header()) && units.size() + 1 == csv.header().size()) units.emplace_back();
  if (units.size() != csv.header().size()) return {};
  units.front() = std::string("s");
  return units;
}

namespace {

bool are_numbers_between_blanks(std::string_view line) {
  int numbers = 0;
  for (std::size_t from = line.find_first_not_of(blanks), to = 0; from < line.size();
       from = line.find_first_not_of(blanks, to), ++numbers) {
    to = std::min(line.find_first_of(blanks, from), line.size());
    if (!is_number(std::string(line.substr(from, to - from)))) return false;
  }
  return numbers > 1;
}

// As old recorders and plotting programs write them.
bool are_parted_by_blanks(const CsvCursor& csv) {
  if (csv.header().size() != 1) return false;
  const std::vector<Above::Line> rows = look_ahead(csv).lines;
  return are_numbers_between_blanks(csv.header_text()) ||
         std::any_of(rows.begin(), rows.end(), [](const auto& row) { return are_numbers_between_blanks(row.text); });
}

// "A [bar]" is a port of the pressures that the row above speaks of.
bool is_port(const std::string& name) {
  const std::string_view bare = trimmed(std::string_view(name).substr(0, name.find_first_of("[(")), blanks);
  return bare == "A" || bare == "B" || bare == "P";
}

// Names that stand over several columns.
std::set<std::string> repeated(const std::vector<std::string>& names) {
  std::map<std::string, long> columns;
  std::set<std::string> repeated;
  for (const std::string& name : names)
    if (!name.empty() && ++columns[name] > 1) repeated.insert(name);
  return repeated;
}

// "Weg; Weg" below "Ventil; Kolben", or "Weg; Weg; Kraft" below "Ventil; Kolben; ": a name that stands over several
// columns, and a port, has the name of its group before it, which holds up to the next. As they are where that does not
// tell all apart.
std::vector<std::string> with_groups(const std::vector<std::string>& names, const std::vector<std::string>& groups) {
  const std::set<std::string> several = repeated(names);
  if (names.size() != groups.size() || several.empty()) return names;
  if (!is_row_of_words(groups) || !as_units(groups).empty()) return names;
  std::vector<std::string> named = names;
  std::string group;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (!groups[c].empty()) group = groups[c];
    if (!group.empty() && (several.contains(names[c]) || is_port(names[c]))) named[c] = group + " " + names[c];
  }
  return repeated(named).empty() ? named : names;
}

}  // namespace

void require_names(const CsvCursor& csv, const std::string& path) {
  const auto& header = csv.header();
  if (are_parted_by_blanks(csv))
    throw InputError({path, csv.header_line(), ""}, "its cells are parted by blanks",
                     "part them by ';' or tabs, as awk '{$1=$1}1' OFS=';' does where no name or unit holds a blank");
  if (header.size() > 1 && std::all_of(header.begin(), header.end(), is_sample))
    throw InputError({path, csv.header_line(), ""}, "there is no header row: the first row is numbers",
                     "write a row of 'name [unit]' above it");
}

long pass_lines_above_header(CsvCursor& csv, const std::string& path) {
  if (is_row_of_numbers(csv.header_text())) csv.header_from_comment();
  const Above above = look_ahead(csv);
  if (!above.numbers) return 0;
  const auto [separator, width] = *above.numbers;
  const auto fits = [width = width](const std::vector<std::string>& cells) {
    return cells.size() == width || (cells.size() == width + 1 && ends_with_comment(cells));
  };
  std::vector<std::vector<std::string>> rows = {csv.header()};
  for (const Above::Line& line : above.lines) rows.push_back(cells_of(line.text, separator));
  for (const auto& cells : rows)
    if (fits(cells) && are_pairs(cells))
      throw InputError({path, above.numbers_line, ""},
                       "its columns go in pairs, a time and a value each: every signal has a time of its own",
                       "export with one time column for all signals, or delete all but the first time column and "
                       "write a row of 'name [unit]' above the numbers");
  if (above.lines.empty()) return 0;
  std::size_t best = fits(rows.front()) ? 0 : rows.size() - 1;
  if (!fits(rows[best])) return 0;
  if (best > 1 && fits(rows[best - 1]) && !as_units(rows[best]).empty()) --best;
  long most = known_names(rows[best]);
  for (std::size_t k = rows.size() - std::min(rows.size(), most_judged); k < rows.size(); ++k)
    if (k != best && fits(rows[k]) && as_units(rows[k]).empty() && known_names(rows[k]) > most)
      best = k, most = known_names(rows[k]);
  if (best == 0) return 0;
  csv.header_at(above.lines[best - 1].at, separator);
  csv.name_columns(with_groups(csv.header(), rows[best - 1]));
  return static_cast<long>(best);
}

}  // namespace servodx
