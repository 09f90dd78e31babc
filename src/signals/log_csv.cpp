// CSV logs: separator, quotes and lines are the cursor's business, signals and units the columns'.
#include <fmt/format.h>

#include <limits>
#include <optional>

#include "base/block_reader.h"
#include "base/csv.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/rig.h"
#include "signals/guess.h"
#include "signals/log_columns.h"
#include "signals/log_formats.h"

namespace servodx {

Log read_csv_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  constexpr long rows_before_estimate = 1000;
  BlockReader file(path);
  CsvCursor csv(file, path);
  const long above = pass_lines_above_header(csv);
  LogColumns log(path, rig, options, {});
  if (above > 0)
    log.note(fmt::format("{}:{}: the header; left out {} row{} above it", path, csv.header_line(), above,
                         above == 1 ? "" : "s"));
  std::vector<int> target;  // of each column of the file: its position among the signals, or -1
  bool in_row = csv.next_row();
  const std::vector<std::string> units = in_row ? units_row(csv) : std::vector<std::string>{};
  for (std::size_t c = 0; c < csv.header().size(); ++c) {
    const std::string& cell = csv.header()[c];
    // A word that is no unit of the table is the rig file's to replace.
    const bool known = c < units.size() && find_unit(units[c]) && !cell.ends_with(']');
    target.push_back(log.add(known ? cell + " [" + units[c] + "]" : cell, csv.header_line()));
  }
  log.require_signals();
  if (!units.empty()) in_row = csv.next_row();

  const std::size_t width = target.size();
  std::vector<double> row(log.size());
  const bool all_are_signals = log.size() == width;
  for (long rows = 1; in_row; ++rows, in_row = csv.next_row()) {
    // Rows so far give the rows to come; without it the columns grow by copying and take twice their size.
    if (rows == rows_before_estimate)
      log.reserve(static_cast<std::size_t>(1.02 * static_cast<double>(rows_before_estimate) *
                                           static_cast<double>(file.file_size()) /
                                           static_cast<double>(csv.bytes_taken())));
    if (all_are_signals && csv.next_plain_row(row)) {
      log.append(row, csv.line());
      continue;
    }
    std::optional<InputError> fault;
    std::size_t cells = 0;
    bool last_is_empty = false;
    for (; cells < width; ++cells) {
      const int to = target[cells];
      if (to < 0) {
        if (!csv.skip_cell()) break;
        continue;
      }
      const Cell kind = csv.next_number(row[to]);
      if (kind == Cell::none) break;
      last_is_empty = kind == Cell::missing;
      if (kind == Cell::text && !fault)
        fault.emplace(Place{path, csv.line(), log.name(to)}, fmt::format("'{}' is not a number", csv.last_text()),
                      csv.separator() == ';' ? "write a number, or leave the cell empty"
                                             : "write a number with a decimal point, or leave the cell empty");
    }
    std::size_t found = cells;
    while (csv.skip_cell()) ++found;
    if (csv.row_ended_by_file() && (fault || found != width || last_is_empty)) {
      log.note(fmt::format("{}:{}: dropped the last line: it is cut short and has no line end", path, csv.line()));
      break;
    }
    if (found != width)
      log.refuse(csv.line(), "", fmt::format("ragged row: {} cells, the header has {}", found, width),
                 found > width && csv.separator() == ','
                     ? "write one cell a column; a decimal comma needs ';' as separator"
                     : "write one cell a column");
    if (fault) throw *fault;
    log.append(row, csv.line());
  }
  return log.finish(file.sha256());
}

}  // namespace servodx
