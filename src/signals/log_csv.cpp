// CSV logs: separator, quotes and lines are the cursor's business, signals and units the columns'.
#include <fmt/format.h>

#include <limits>
#include <optional>

#include "base/block_reader.h"
#include "base/csv.h"
#include "base/trouble.h"
#include "base/units.h"
#include "servodx/error.h"
#include "servodx/log.h"
#include "servodx/note.h"
#include "servodx/rig.h"
#include "signals/header.h"
#include "signals/log_columns.h"
#include "signals/log_formats.h"
#include "signals/time_stamp.h"

namespace servodx {
namespace {

class CsvReader {
 public:
  CsvReader(const std::string& path, const RigFile& rig, const ReadOptions& options)
      : path_(path), file_(path), csv_(file_, path), log_(path, rig, options, {}) {}

  Log read() {
    read_header();
    read_rows();
    return log_.finish(file_.sha256());
  }

 private:
  void read_header() {
    const long above = pass_lines_above_header(csv_, path_);
    if (above > 0)
      log_.note(Note::Kind::preamble, fmt::format("{}: the header is in line {}; {} row{} of other text above it",
                                                  path_, csv_.header_line(), above, above == 1 ? "" : "s"));
    const RowsBelow below = pass_rows_below_header(csv_, path_);
    const std::vector<std::string>& units = below.units;
    if (const long others = below.passed - !units.empty(); others > 0)
      log_.note(Note::Kind::preamble, fmt::format("{}: {} row{} of other text below the header in line {}", path_,
                                                  others, others == 1 ? "" : "s", csv_.header_line()));
    in_row_ = below.in_row;
    const std::vector<std::string> first = in_row_ ? csv_.row_ahead() : std::vector<std::string>{};
    require_as_many_cells(csv_, first, path_);
    for (std::size_t c = 0; c < csv_.header().size(); ++c) {
      const std::string& cell = csv_.header()[c];
      const bool bare = !cell.ends_with(']');
      // A word that is no unit of the table is the rig file's to replace.
      const bool known = c < units.size() && find_unit(units[c]) && bare;
      const auto stamp = c < first.size() ? parse_time_stamp(first[c]) : std::nullopt;
      const std::string name = known ? cell + " [" + units[c] + "]" : stamp && bare ? cell + " [s]" : cell;
      target_.push_back(log_.add(name, csv_.header_line()));
      if (stamp && target_.back() >= 0 && log_.signal(target_.back()) == Signal::time)
        stamps_.emplace(*stamp), stamped_ = target_.back();
    }
    if (log_.size() == 0) require_names(csv_, path_);
    note_channel_numbers();
    log_.require_signals();
    may_lack_last_ = ends_with_comment(csv_.header()) && target_.back() < 0;
    if (may_lack_last_ && first.size() + 1 == target_.size()) target_.pop_back();
  }

  void note_channel_numbers() {
    std::size_t time = 0;
    while (time < target_.size() && !(target_[time] >= 0 && log_.signal(target_[time]) == Signal::time)) ++time;
    if (in_row_ && begins_with_channel_numbers(csv_, time, path_))
      log_.note(Note::Kind::preamble,
                fmt::format("{}:{}: the first row is unlike those below it: if it numbers the channels, delete it",
                            path_, csv_.line()));
  }

  void read_rows() {
    constexpr long rows_before_estimate = 1000;
    row_.resize(log_.size());
    const bool all_are_signals = log_.size() == target_.size() && !stamps_;
    for (long rows = 1; in_row_; ++rows, in_row_ = csv_.next_row()) {
      // Rows so far give the rows to come; without it the columns grow by copying and take twice their size.
      if (rows == rows_before_estimate)
        log_.reserve(static_cast<std::size_t>(1.02 * static_cast<double>(rows_before_estimate) *
                                              static_cast<double>(file_.file_size()) /
                                              static_cast<double>(csv_.bytes_taken())));
      if (!(all_are_signals && csv_.next_plain_row(row_)) && !read_odd_row()) break;
      if (const CellAt* cell = csv_.thousands_among_commas())
        log_.refuse_as(Trouble::row, cell->line, "",
                       fmt::format("'{}' has a point where other numbers have a decimal comma", cell->text),
                       "write all numbers with one decimal sign, and thousands without a point");
      log_.append(row_, csv_.line());
    }
  }

  // Cell by cell; false: it is the file's last, and cut short.
  bool read_odd_row() {
    const std::size_t width = target_.size();
    std::optional<DocumentedError> fault;
    std::size_t cells = 0;
    bool last_is_empty = false, is_header = false;
    for (; cells < width; ++cells) {
      const int to = target_[cells];
      if (to < 0) {
        if (!csv_.skip_cell()) break;
        continue;
      }
      const Cell kind = csv_.next_number(row_[to]);
      if (kind == Cell::none) break;
      last_is_empty = kind == Cell::missing;
      is_header = is_header || (kind == Cell::text && csv_.last_text() == csv_.header()[cells]);
      if (stamps_ && to == stamped_ && kind != Cell::missing) {
        if (!take_stamp(to) && !fault)
          fault.emplace(Trouble::row, Place{path_, csv_.line(), log_.name(to)},
                        fmt::format("'{}' is no time stamp like the first row's", csv_.last_text()),
                        "write all times in one form");
      } else if (kind == Cell::text && !fault) {
        fault.emplace(Trouble::row, Place{path_, csv_.line(), log_.name(to)},
                      fmt::format("'{}' is not a number", csv_.last_text()),
                      csv_.decimal_comma() ? "write a number, or leave the cell empty"
                                           : "write a number with a decimal point, or leave the cell empty");
      }
    }
    std::size_t found = cells;
    while (csv_.skip_cell()) ++found;
    const bool ragged = found != width && !(may_lack_last_ && (found == width + 1 || found + 1 == width));
    if (csv_.row_ended_by_file() && (fault || ragged || last_is_empty)) {
      log_.note(Note::Kind::left_out,
                fmt::format("{}:{}: dropped the last line: it is cut short and has no line end", path_, csv_.line()));
      return false;
    }
    if (ragged || fault) refuse_second_header(csv_, is_header, path_);
    if (ragged) refuse_ragged(csv_, found, path_);
    if (fault) throw *fault;
    return true;
  }

  // The cell just read as a time in the column's unit.
  bool take_stamp(int column) {
    std::string text = csv_.last_text();
    std::erase(text, '"');
    const auto stamp = parse_time_stamp(text);
    const auto seconds = stamp ? stamps_->seconds(*stamp) : std::nullopt;
    if (seconds) row_[column] = *seconds / log_.si(column, 1.0);
    return seconds.has_value();
  }

  const std::string& path_;
  BlockReader file_;
  CsvCursor csv_;
  LogColumns log_;
  std::vector<int> target_;  // of each column of the file: its position among the signals, or -1
  std::vector<double> row_;
  std::optional<StampClock> stamps_;  // the times are stamps
  int stamped_ = -1;
  bool in_row_ = false, may_lack_last_ = false;
};

}  // namespace

Log read_csv_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  return CsvReader(path, rig, options).read();
}

}  // namespace servodx
