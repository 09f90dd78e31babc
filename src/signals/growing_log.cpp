#include "signals/growing_log.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/csv.h"
#include "base/decimal.h"
#include "base/file_kind.h"
#include "base/trimmed.h"
#include "base/units.h"
#include "servodx/error.h"
#include "signals/header.h"
#include "signals/log_columns.h"

namespace servodx {
namespace {

constexpr std::string_view stamps_from = "stamps in column ";  // a comment of the head: "3|2021-03-04 10:11:12"
constexpr std::size_t most_above = 200;                        // lines before a row of numbers
constexpr std::size_t longest_line = std::size_t{1} << 16;     // [bytes] more is no line of a log

constexpr std::string_view blanks = " \t\r\"";

// False where the cell is text; a missing number is NaN.
bool number_of(std::string_view cell, char point, double& value) {
  cell = trimmed(cell, blanks);
  value = std::numeric_limits<double>::quiet_NaN();
  if (cell.empty()) return true;
  double x = 0;
  const char* const end = cell.data() + cell.size();
  if (parse_decimal(cell.data(), end, point, x) == end) {
    value = x;
    return true;
  }
  const auto [at, wrong] = std::from_chars(cell.data() + (cell.front() == '+'), end, x);
  if (wrong != std::errc() || at != end) return false;
  if (std::isfinite(x)) value = x;  // "nan" is a number to from_chars
  return true;
}

// The line of the header; with the names of groups where it took some from the row above it.
std::string head_of(const CsvCursor& csv, const std::string& line) {
  const std::string text = line + "\n";
  if (CsvCursor(std::string_view(text), "").header() == csv.header()) return text;
  std::string head;
  for (std::size_t c = 0; c < csv.header().size(); ++c) {
    if (c > 0) head += csv.separator();
    append_cell(head, csv.header()[c]);
  }
  return head + "\n";
}

}  // namespace

GrowingLog::GrowingLog(std::string name, const RigFile& rig) : name_(std::move(name)), rig_(&rig) {}
GrowingLog::~GrowingLog() = default;
GrowingLog::GrowingLog(GrowingLog&&) noexcept = default;
GrowingLog& GrowingLog::operator=(GrowingLog&&) noexcept = default;

void GrowingLog::begin_with(const std::string& head, std::uint64_t at) {
  head_ = head;
  stamps_.reset();
  read_head("");
  half_.clear();
  fed_ = at;
}

bool GrowingLog::has(Signal signal) const {
  for (std::size_t c = 0; columns_ && c < columns_->size(); ++c)
    if (columns_->signal(static_cast<int>(c)) == signal) return true;
  return false;
}

std::string GrowingLog::unit_of(Signal signal) const {
  for (std::size_t c = 0; columns_ && c < columns_->size(); ++c)
    if (columns_->signal(static_cast<int>(c)) == signal) return columns_->written_unit(static_cast<int>(c));
  return "";
}

void GrowingLog::feed(std::string_view bytes, const Take& take) {
  while (!bytes.empty()) {
    const auto end = bytes.find('\n');
    const std::string_view part = bytes.substr(0, end);
    fed_ += part.size() + (end != std::string_view::npos);
    if (end == std::string_view::npos) {
      half_ += part;
      if (half_.size() > longest_line) half_.clear(), ++bad_lines_;
      return;
    }
    bytes.remove_prefix(end + 1);
    if (half_.empty()) {
      line(part, fed_, take);
    } else {
      half_ += part;
      const std::string whole = std::exchange(half_, {});
      line(whole, fed_, take);
    }
  }
}

void GrowingLog::end(const Take& take) {
  if (half_.empty()) return;
  // A last line without its end may be cut short within a number: it is taken where it has all its cells.
  const std::string whole = std::exchange(half_, {});
  line(whole, fed_, take);
}

// A header is known by the row of numbers below it, which is the first sample.
void GrowingLog::line(std::string_view text, std::uint64_t end, const Take& take) {
  if (trimmed(text, blanks).empty()) return;
  if (!columns_ && !begins_with(text)) return;
  Sample sample;
  if (read_sample(text, sample))
    take(sample, end);
  else
    ++bad_lines_;
}

// Whether this is the row of numbers that a header stands above.
bool GrowingLog::begins_with(std::string_view text) {
  if (trimmed(text, blanks).front() == '#') {
    comment_ = text;
    return false;
  }
  if (above_.empty()) refuse_binary(text, name_);
  const bool numbers = is_row_of_numbers(text);
  if (above_.empty() && numbers) take_comment(text);
  // A header that is none has to be told before a log has grown long.
  if (above_.empty() || (!numbers && above_.size() < most_above)) {
    above_.emplace_back(text);
    return false;
  }
  const std::string first = std::string(text) + "\n";
  std::string all;
  for (const std::string& each : above_) all += each + "\n";
  all += first;
  CsvCursor csv(std::string_view(all), name_);
  const auto above = static_cast<std::size_t>(pass_lines_above_header(csv, name_));
  head_ = head_of(csv, above_[above]);
  const RowsBelow below = pass_rows_below_header(csv, name_);
  if (below.units_at >= 0) head_ += above_[above + 1 + static_cast<std::size_t>(below.units_at)] + "\n";
  const std::size_t taken = above + 1 + static_cast<std::size_t>(below.passed);
  read_head(first);
  bad_lines_ += static_cast<long>(above_.size() - taken);
  above_.clear();
  return true;
}

// Names behind a '#' right above the first row of numbers are the header.
void GrowingLog::take_comment(std::string_view numbers) {
  const std::string both = comment_ + "\n" + std::string(numbers) + "\n";
  CsvCursor csv(std::string_view(both), name_);
  pass_lines_above_header(csv, name_);
  require_names(csv, name_);
  above_.push_back(comment_.substr(comment_.find('#') + 1));
}

// `first`: the first row of numbers, empty where the head was read before.
void GrowingLog::read_head(const std::string& first) {
  const std::string text = head_ + first;
  CsvCursor csv(std::string_view(text), name_);
  auto columns = std::make_unique<LogColumns>(name_, *rig_, *options_, LogFormat{});
  const RowsBelow below = pass_rows_below_header(csv, name_);
  const std::vector<std::string>& units = below.units;
  std::vector<std::string> cells = below.in_row ? csv.row_ahead() : std::vector<std::string>{};
  require_as_many_cells(csv, cells, name_);
  for (const std::string& comment : csv.comments())
    if (comment.starts_with(stamps_from)) {
      cells.resize(csv.header().size());
      const auto bar = comment.find('|');
      std::size_t column = 0;
      std::from_chars(comment.data() + stamps_from.size(), comment.data() + comment.size(), column);
      if (bar != comment.npos && column < cells.size()) cells[column] = comment.substr(bar + 1);
    }
  target_.clear();
  for (std::size_t c = 0; c < csv.header().size(); ++c) {
    const std::string& cell = csv.header()[c];
    const bool bare = !cell.ends_with(']');
    const bool known = c < units.size() && find_unit(units[c]) && bare;
    const auto stamp = c < cells.size() ? parse_time_stamp(cells[c]) : std::nullopt;
    target_.push_back(columns->add(known           ? cell + " [" + units[c] + "]"
                                   : stamp && bare ? cell + " [s]"
                                                   : cell,
                                   csv.header_line()));
    if (!stamp || target_.back() < 0 || columns->signal(target_.back()) != Signal::time) continue;
    stamps_.emplace(*stamp);
    if (csv.comments().empty()) head_ = fmt::format("# {}{}|{}\n{}", stamps_from, c, cells[c], head_);
  }
  if (columns->size() == 0) require_names(csv, name_);
  columns->require_signals();
  may_lack_last_ = ends_with_comment(csv.header()) && target_.back() < 0;
  separator_ = csv.separator();
  columns_ = std::move(columns);
}

// The time of a row: a number, or a stamp where the first row's is one. [s]
bool GrowingLog::time_of(std::string_view cell, int column, double& time) {
  if (stamps_) {
    const auto stamp = parse_time_stamp(trimmed(cell, blanks));
    const auto seconds = stamp ? stamps_->seconds(*stamp) : std::nullopt;
    if (seconds) time = *seconds;
    return seconds.has_value();
  }
  double value = 0;
  if (!number_of(cell, point(), value)) return false;
  time = columns_->si(column, value);
  return true;
}

bool GrowingLog::read_sample(std::string_view text, Sample& to) {
  std::size_t cells = 0;
  double time = std::numeric_limits<double>::quiet_NaN();
  for (bool more = true; more; ++cells) {
    const auto end = text.find(separator_);
    more = end != std::string_view::npos;
    if (cells > target_.size() - (may_lack_last_ ? 0 : 1)) return false;
    const int column = cells < target_.size() ? target_[cells] : -1;
    if (column >= 0) {
      const Signal signal = columns_->signal(column);
      double value = 0;
      if (signal == Signal::time) {
        if (!time_of(text.substr(0, end), column, time) || std::isinf(time)) return false;
      } else if (number_of(text.substr(0, end), point(), value)) {
        to[signal] = columns_->si(column, value);
        if (std::isinf(to[signal])) return false;
      } else {
        return false;
      }
    }
    if (more) text.remove_prefix(end + 1);
  }
  to.time = time;
  const bool whole = cells == target_.size() || (may_lack_last_ && cells + 1 >= target_.size());
  return whole && std::isfinite(time);
}

}  // namespace servodx
