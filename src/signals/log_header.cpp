#include "signals/log_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

#include "base/block_reader.h"
#include "base/csv.h"
#include "servodx/error.h"
#include "signals/header.h"
#include "signals/log_formats.h"
#include "signals/mat_file.h"
#include "signals/time_stamp.h"

namespace servodx {
namespace {

// The numbers of a CSV log's columns; date-time stamps as such.
std::vector<ColumnNumbers> numbers_of_rows(CsvCursor& csv, bool in_row, const std::string& path) {
  std::vector<NumbersCollector> collectors(csv.header().size());
  std::vector<bool> words(collectors.size(), false), stamps = words;
  const std::size_t most = collectors.size() + ends_with_comment(csv.header());
  for (; in_row; in_row = csv.next_row()) {
    bool is_header = false, new_words = false;
    for (std::size_t c = 0; c < collectors.size(); ++c) {
      double value = 0;
      const Cell kind = csv.next_number(value);
      if (kind == Cell::none) break;
      if (kind == Cell::text && !words[c]) {
        words[c] = true;
        stamps[c] = parse_time_stamp(csv.last_text()).has_value();
        new_words = new_words || !stamps[c];
        is_header = is_header || (!stamps[c] && csv.last_text() == csv.header()[c]);
      }
      collectors[c].take(kind == Cell::number ? value : std::nan(""));
    }
    std::size_t cells = collectors.size();
    while (csv.skip_cell()) ++cells;
    // Once a row: it looks at 200 lines, and a row may have 10,000 words.
    if (new_words) refuse_second_header(csv, is_header, path);
    if (cells > most) refuse_ragged(csv, cells, path);
  }
  std::vector<ColumnNumbers> numbers;
  for (std::size_t c = 0; c < collectors.size(); ++c) {
    numbers.push_back(collectors[c].numbers());
    numbers.back().stamps = stamps[c] && numbers.back().count == 0;
  }
  return numbers;
}

LogHeader read_csv_header(const std::string& path) {
  BlockReader file(path);
  CsvCursor csv(file, path);
  pass_lines_above_header(csv, path);
  require_names(csv, path);
  std::vector<std::string> above = units_above(csv.from_beginning(), csv);  // which the rows below may drop
  const RowsBelow below = pass_rows_below_header(csv, path);
  if (!below.units.empty()) above.clear();
  if (below.in_row) require_as_many_cells(csv, csv.row_ahead(), path);
  LogHeader header{guess_columns(csv.header(), below.units.empty() ? above : below.units),
                   numbers_of_rows(csv, below.in_row, path)};
  if (!above.empty())
    for (ColumnGuess& g : header.columns) g.unit_in_brackets = false;  // the reader looks for none so far above
  return header;
}

// A MAT file's vectors of the commonest length, which are its signals.
LogHeader read_mat_header(const std::string& path) {
  std::vector<MatVariable> variables = read_mat_variables(path);
  std::map<std::size_t, std::size_t> lengths;
  for (const MatVariable& v : variables)
    if (v.fault.empty() && v.numbers.size() > 1) ++lengths[v.numbers.size()];
  const auto commonest = std::max_element(lengths.begin(), lengths.end(),
                                          [](const auto& a, const auto& b) { return a.second < b.second; });
  if (commonest == lengths.end())
    throw InputError({path, 0, ""}, "holds no vectors of numbers",
                     "save each signal as a vector, or a matrix with a list of its columns' names");
  std::erase_if(variables,
                [&](const MatVariable& v) { return !v.fault.empty() || v.numbers.size() != commonest->first; });
  std::vector<std::string> names;
  LogHeader header;
  for (const MatVariable& v : variables) {
    names.push_back(v.name);
    NumbersCollector collector;
    for (const double x : v.numbers) collector.take(x);
    header.numbers.push_back(collector.numbers());
  }
  header.columns = guess_columns(names);
  for (ColumnGuess& g : header.columns) {
    g.unit_in_brackets = false;                  // a variable has no unit
    if (g.unit.empty()) g.written_unit.clear();  // nor is the index in "run(:,2)" one
  }
  return header;
}

}  // namespace

LogHeader read_log_header(const std::string& path) {
  LogHeader header = is_mat_file(path) ? read_mat_header(path) : read_csv_header(path);
  ask_by_numbers(header.columns, header.numbers);
  for (ColumnGuess& g : header.columns) {
    const auto same = std::count_if(header.columns.begin(), header.columns.end(),
                                    [&](const ColumnGuess& other) { return other.cell == g.cell; });
    if (g.signal && same > 1) g.ask(fmt::format("the name stands over {} columns: give each its own", same));
  }
  return header;
}

}  // namespace servodx
