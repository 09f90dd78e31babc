#include "signals/growing_log.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/csv.h"
#include "base/decimal.h"
#include "base/units.h"
#include "servodx/error.h"
#include "signals/guess.h"
#include "signals/log_columns.h"

namespace servodx {
namespace {

constexpr std::size_t longest_line = std::size_t{1} << 16;  // [bytes] more is no line of a log

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '"'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// False where the cell is text; a missing number is NaN.
bool number_of(std::string_view cell, char point, double& value) {
  cell = trimmed(cell);
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

}  // namespace

GrowingLog::GrowingLog(std::string name, const RigFile& rig) : name_(std::move(name)), rig_(&rig) {}
GrowingLog::~GrowingLog() = default;
GrowingLog::GrowingLog(GrowingLog&&) noexcept = default;
GrowingLog& GrowingLog::operator=(GrowingLog&&) noexcept = default;

void GrowingLog::begin_with(const std::string& head, std::uint64_t at) {
  head_.clear();
  read_head(head);
  head_ = head;
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

// The header is known by the line below it, which is one of units or the first sample.
void GrowingLog::line(std::string_view text, std::uint64_t end, const Take& take) {
  if (trimmed(text).empty()) return;
  if (!columns_) {
    if (trimmed(text).front() == '#') return;
    if (head_.empty()) {
      head_ = std::string(text) + "\n";
      return;
    }
    const std::string both = head_ + std::string(text) + "\n";
    if (read_head(both)) {
      head_ = both;
      return;
    }
  }
  Sample sample;
  if (read_sample(text, sample))
    take(sample, end);
  else
    ++bad_lines_;
}

// Whether its second line is one of units.
bool GrowingLog::read_head(const std::string& text) {
  CsvCursor csv(std::string_view(text), name_);
  auto columns = std::make_unique<LogColumns>(name_, *rig_, *options_, LogFormat{});
  const std::vector<std::string> units = csv.next_row() ? units_row(csv) : std::vector<std::string>{};
  target_.clear();
  for (std::size_t c = 0; c < csv.header().size(); ++c) {
    const std::string& cell = csv.header()[c];
    const bool known = c < units.size() && find_unit(units[c]) && !cell.ends_with(']');
    target_.push_back(columns->add(known ? cell + " [" + units[c] + "]" : cell, csv.header_line()));
  }
  columns->require_signals();
  separator_ = csv.separator();
  columns_ = std::move(columns);
  return !units.empty();
}

bool GrowingLog::read_sample(std::string_view text, Sample& to) const {
  std::size_t cells = 0;
  double time = std::numeric_limits<double>::quiet_NaN();
  for (bool more = true; more; ++cells) {
    const auto end = text.find(separator_);
    more = end != std::string_view::npos;
    if (cells >= target_.size()) return false;
    const int column = target_[cells];
    double value = 0;
    if (column >= 0) {
      if (!number_of(text.substr(0, end), separator_ == ';' ? ',' : '.', value)) return false;
      const double si = columns_->si(column, value);
      if (std::isinf(si)) return false;
      const Signal signal = columns_->signal(column);
      if (signal == Signal::time)
        time = si;
      else
        to[signal] = si;
    }
    if (more) text.remove_prefix(end + 1);
  }
  to.time = time;
  return cells == target_.size() && std::isfinite(time);
}

}  // namespace servodx
