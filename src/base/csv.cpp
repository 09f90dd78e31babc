#include "base/csv.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <tuple>

#include "base/block_reader.h"
#include "base/file_kind.h"
#include "base/reading_limits.h"

namespace servodx {
namespace {

// Limits beyond any log or table, so that a file without line ends, or of separators alone, costs no more than these.
constexpr std::size_t longest_row = std::size_t{16} << 20;  // [byte]
constexpr std::size_t most_comments = longest_row;
constexpr std::size_t most_columns = 10000;

constexpr double missing_value = std::numeric_limits<double>::quiet_NaN();

// A comma with a blank behind it ("pressure, bar") is a part of a name where semicolons or tabs stand as well.
char sniff_separator(std::string_view line) {
  long counts[3] = {}, in_names = 0;
  const char candidates[3] = {';', '\t', ','};
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    for (int i = 0; i < 3; ++i) counts[i] += c == candidates[i];
    in_names += c == ',' && k + 1 < line.size() && line[k + 1] == ' ';
  }
  if (counts[0] + counts[1] > 0) counts[2] -= in_names;
  const auto best = std::max_element(counts, counts + 3) - counts;
  return counts[best] > 0 ? candidates[best] : ',';
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto c = static_cast<unsigned char>(text[i++]);
    int more = c < 0x80 ? 0 : c >= 0xC2 && c < 0xE0 ? 1 : c >= 0xE0 && c < 0xF0 ? 2 : c >= 0xF0 && c < 0xF5 ? 3 : -1;
    for (; more > 0 && i < text.size() && (text[i] & 0xC0) == 0x80; --more) ++i;
    if (more != 0) return false;
  }
  return true;
}

// Words of a recorder that writes Latin-1, as most that are no UTF-8 do.
std::string as_utf8(std::string text) {
  if (is_utf8(text)) return text;
  std::string wide;
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (u < 0x80) {
      wide += c;
    } else {
      wide += static_cast<char>(0xC0 | u >> 6);
      wide += static_cast<char>(0x80 | (u & 0x3F));
    }
  }
  return wide;
}

// A number that std::from_chars did not take whole: sign '+', decimal comma, range. `text` is trimmed.
Cell parse_cell(std::string_view text, bool decimal_comma, double& value) {
  char buffer[64];
  value = missing_value;
  if (text.empty()) return Cell::missing;
  if (text.size() >= sizeof buffer) return Cell::text;
  std::size_t size = 0;
  bool comma = false;
  for (char c : text) {
    if (c == ',' && decimal_comma && !comma) {
      comma = true;
      c = '.';
    } else if (c == ',' || (comma && c == '.')) {
      return Cell::text;
    }
    buffer[size++] = c;
  }
  buffer[size] = '\0';
  const char* first = buffer;
  if (size > 1 && buffer[0] == '+' && buffer[1] != '-') ++first;
  const char* const last = buffer + size;
  auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::result_out_of_range) {
    value = std::strtod(first, nullptr);
    error = std::abs(value) < 1.0 ? std::errc() : std::errc::invalid_argument;  // an underflow is its nearest double
  }
  if (error != std::errc() || end != last || std::isinf(value)) {
    value = missing_value;
    return Cell::text;
  }
  return std::isnan(value) ? Cell::missing : Cell::number;
}

}  // namespace

std::string read_file_within(const std::string& path, std::size_t most) {
  struct Descriptor {
    int fd;
    ~Descriptor() {
      if (fd >= 0) ::close(fd);
    }
  } file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  const auto refuse = [&](const std::string& why) {
    throw InputError({path, 0, ""}, "cannot be read: " + why, "check the path and its permissions");
  };
  struct stat status {};
  if (file.fd < 0 || ::fstat(file.fd, &status) != 0) refuse(std::strerror(errno));
  if (S_ISDIR(status.st_mode)) refuse("it is a folder");
  const auto refuse_beyond = [&](std::size_t size) {
    if (size > most)
      throw InputError({path, 0, ""},
                       "has more than " + std::to_string(most >> 20) + " MB, the most that such a file may",
                       "give the file that is meant");
  };
  refuse_beyond(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0);
  std::string text;
  text.resize(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) + 1 : std::size_t{1} << 16);
  std::size_t size = 0;
  while (true) {
    if (size == text.size()) text.resize(2 * size);
    const ssize_t got = ::read(file.fd, text.data() + size, text.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(std::strerror(errno));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
    refuse_beyond(size);
  }
  text.resize(size);
  return text;
}

std::string read_file(const std::string& path) {
  return read_file_within(path, std::numeric_limits<std::size_t>::max());
}

CsvCursor::CsvCursor(std::string_view text, std::string path)
    : path_(std::move(path)), begin_(text.data()), whole_(text.data() + text.size()), p_(text.data()), end_(whole_) {
  read_header();
}

CsvCursor::CsvCursor(BlockReader& file, std::string path) : path_(std::move(path)), file_(&file) {
  refill();
  read_header();
}

void CsvCursor::read_header() {
  const std::string_view text(p_, static_cast<std::size_t>(end_ - p_));
  refuse_binary(text, path_);
  if (text.starts_with("\xEF\xBB\xBF")) p_ += 3;
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    throw InputError({path_, 1, ""}, "the text is UTF-16", "save the file as UTF-8");
  if (const auto cr = text.find('\r'); cr < text.size() - 1 && text.find('\n') == text.npos)
    throw InputError({path_, 1, ""}, "its lines end in CR alone", "save the file with line ends of LF or CRLF");
  std::size_t in_comments = 0;
  while (next_row()) {
    const char* stop = std::find(p_, end_, '\n');
    std::string_view line(p_, static_cast<std::size_t>(stop - p_));
    if (line.starts_with('#')) {
      if (line.ends_with('\r')) line.remove_suffix(1);
      line.remove_prefix(1);
      if (line.starts_with(' ')) line.remove_prefix(1);
      in_comments += line.size();
      if (in_comments > most_comments)
        throw InputError({path_, line_, ""}, "the comments above the header have more than 16 MB", "take them out");
      comments_.emplace_back(line);
      comment_line_ = line_;
      p_ = stop;
      more_ = false;
      continue;
    }
    return take_header(0);
  }
  throw InputError({path_, 0, ""}, "the file has no header row", "begin it with a row of column names");
}

// The row just begun.
void CsvCursor::take_header(char separator) {
  separator_ = separator ? separator : sniff_separator({p_, static_cast<std::size_t>(std::find(p_, end_, '\n') - p_)});
  point_ = separator_ == ',' ? '.' : ',';
  header_line_ = line_;
  header_row_ = p_;
  header_.clear();
  for (std::string cell; next_cell(cell);) {
    if (header_.size() == most_columns)
      throw InputError({path_, line_, ""}, "the header has more than " + std::to_string(most_columns) + " columns",
                       "keep the columns that are needed");
    if (cell.size() > longest_name)
      throw InputError({path_, line_, ""},
                       "the name of column " + std::to_string(header_.size() + 1) + " has more than " +
                           std::to_string(longest_name) + " bytes",
                       "shorten it");
    header_.push_back(as_utf8(std::move(cell)));
  }
}

void CsvCursor::header_at(std::size_t bytes_ahead, char separator) {
  count_line_ends(p_, p_ + bytes_ahead);
  p_ += bytes_ahead;
  more_ = false;
  if (next_row()) take_header(separator);
}

void CsvCursor::take_header_again(char separator) {
  p_ = header_row_;
  next_line_ = line_;
  cell_ = cell_end_ = nullptr;
  in_row_ = more_ = true;
  take_header(separator);
}

std::string_view CsvCursor::header_text() const {
  if (!header_row_) return {};
  return {header_row_, static_cast<std::size_t>(std::find(header_row_, end_, '\n') - header_row_)};
}

void CsvCursor::header_from_comment() {
  if (!header_row_ || comments_.empty()) return;
  const std::string line = comments_.back();
  if (line.find_first_not_of(" \t") == line.npos || line.starts_with('#')) return;
  const CsvCursor names(line, path_);
  take_header_again(names.separator());
  if (names.header().size() != header_.size()) return take_header_again(0);
  header_ = names.header();
  header_line_ = comment_line_;
  comments_.pop_back();
  p_ = header_row_;
  next_line_ = line_;
  in_row_ = more_ = false;
}

std::string_view CsvCursor::from_beginning() const {
  return dropped_ > 0 ? std::string_view{} : std::string_view(begin_, static_cast<std::size_t>(end_ - begin_));
}

void CsvCursor::refuse_long_row(long line) const {
  throw InputError({path_, line, ""}, "the row is longer than " + std::to_string(longest_row >> 20) + " MB",
                   "end each row with a line end, and close quotes");
}

// Of a text in memory; a file's rows are held to it as they come. It looks again only behind a line end in quotes.
void CsvCursor::refuse_row_without_end() {
  if (file_ || (line_end_ && p_ <= line_end_)) return;
  const char* const most = row_ + std::min(longest_row, static_cast<std::size_t>(end_ - row_));
  line_end_ = std::find(std::min(p_, most), most, '\n');
  if (line_end_ == most && most != end_) refuse_long_row(line_);
}

// Keeps what is unused, from the cell being read on.
bool CsvCursor::refill() {
  if (!file_) return false;
  const std::string_view more = file_->next();
  if (more.empty()) {
    whole_ = end_;  // the last line may lack its end
    return false;
  }
  const auto used = p_ ? static_cast<std::size_t>((cell_ ? cell_ : p_) - buffer_.data()) : 0;
  const auto at = p_ ? static_cast<std::size_t>(p_ - buffer_.data()) - used : 0;
  if (buffer_.size() - used > longest_row) refuse_long_row(next_line_);
  header_row_ = nullptr;
  buffer_.erase(0, used);
  dropped_ += used;
  buffer_ += more;
  const char* const begin = begin_ = buffer_.data();
  if (cell_) cell_ = begin;
  p_ = begin + at;
  end_ = begin + buffer_.size();
  const auto line_end = buffer_.rfind('\n');
  whole_ = line_end == std::string::npos ? begin : begin + line_end + 1;
  return true;
}

void CsvCursor::count_line_ends(const char* from, const char* to) { next_line_ += std::count(from, to, '\n'); }

bool CsvCursor::next_row() {
  while (in_row_ && more_) skip_cell();
  in_row_ = false;
  cell_ = cell_end_ = nullptr;
  while (true) {
    while (!row_is_whole() && refill()) {
    }
    const char* q = p_;
    while (q != end_ && (is_blank(*q) || *q == '\r')) ++q;
    if (q == end_) break;
    if (*q != '\n') {
      line_ = next_line_;
      in_row_ = more_ = true;
      row_ = p_;
      line_end_ = nullptr;
      refuse_row_without_end();
      return true;
    }
    p_ = q + 1;
    ++next_line_;
  }
  p_ = end_;
  return false;
}

std::vector<std::string> CsvCursor::row_ahead() {
  const char* const line_end = std::find(p_, end_, '\n');
  // A quoted line end would read on from the file, and what was passed would be gone.
  if (!in_row_ || line_end == end_ || std::count(p_, line_end, '"') % 2 != 0) return {};
  const auto at = std::tuple(p_, cell_, cell_end_, next_line_, more_);
  std::vector<std::string> cells;
  for (std::string cell; cells.size() <= most_columns && next_cell(cell);) cells.push_back(as_utf8(std::move(cell)));
  std::tie(p_, cell_, cell_end_, next_line_, more_) = at;
  return cells;
}

// At the end of a cell's text: steps over trailing blanks and the separator or the line end.
void CsvCursor::finish_cell() {
  if (p_ != end_ && *p_ == separator_) {
    ++p_;
    return;
  }
  more_ = false;
  if (p_ != end_ && *p_ == '\r') ++p_;
  if (p_ != end_ && *p_ == '\n') {
    ++p_;
    ++next_line_;
  }
}

bool CsvCursor::next_cell(std::string& text) {
  if (!in_row_ || !more_) return false;
  while (p_ != end_ && is_blank(*p_)) ++p_;
  cell_ = p_;
  if (p_ != end_ && *p_ == '"') {
    text.clear();
    for (++p_;; ++p_) {
      const char* quote = std::find(p_, end_, '"');
      if (!file_ && static_cast<std::size_t>(quote - row_) > longest_row) refuse_long_row(line_);
      text.append(p_, quote);
      count_line_ends(p_, quote);
      p_ = quote;
      if (p_ == end_) {
        if (!refill()) throw InputError({path_, line_, ""}, "a quoted cell is not closed", "close it with '\"'");
        --p_;  // the loop steps over a character that is not there
        continue;
      }
      ++p_;
      if (p_ == end_) refill();
      if (p_ == end_ || *p_ != '"') break;
      text += '"';
    }
    // The row goes on behind a line end in quotes.
    while (!row_is_whole() && refill()) {
    }
    refuse_row_without_end();
    cell_end_ = p_;
    while (p_ != end_ && is_blank(*p_)) ++p_;
    if (!at_row_end() && *p_ != separator_)
      throw InputError({path_, line_, ""}, "text follows a quoted cell", "double the quotes within the cell");
  } else {
    while (!at_row_end() && *p_ != separator_) ++p_;
    cell_end_ = p_;
    while (cell_end_ != cell_ && is_blank(cell_end_[-1])) --cell_end_;
    text.assign(cell_, cell_end_);
  }
  finish_cell();
  return true;
}

bool CsvCursor::skip_cell() {
  if (!in_row_ || !more_) return false;
  const char* p = p_;
  while (p != end_ && *p != separator_ && *p != '\n' && *p != '\r' && *p != '"') ++p;
  if (p == end_ || *p == '\r' || *p == '"') {
    std::string ignored;
    return next_cell(ignored);
  }
  cell_ = p_;
  cell_end_ = p_ = p;
  finish_cell();
  return true;
}

// What is not a plain decimal with a separator or a line feed behind it.
Cell CsvCursor::next_odd_number(double& value) {
  const auto [after, error] = std::from_chars(p_, end_, value);
  if (error == std::errc() && std::isfinite(value) &&
      (after == end_ || *after == separator_ || *after == '\n' ||
       (*after == '\r' && after + 1 != end_ && after[1] == '\n'))) {
    cell_ = p_;
    if (point_ == ',') look_for_thousands(p_, after);
    cell_end_ = p_ = after;
    finish_cell();
    return Cell::number;
  }
  std::string text;
  next_cell(text);
  const Cell kind = parse_cell(text, point_ == ',', value);
  if (kind == Cell::number && point_ == ',') look_for_thousands(text.data(), text.data() + text.size());
  return kind;
}

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Behind a point: three digits and no fourth.
bool is_group(const char* p, const char* end) {
  return end - p >= 3 && is_digit(p[0]) && is_digit(p[1]) && is_digit(p[2]) && (end - p == 3 || !is_digit(p[3]));
}

// One to three digits, the first no nought, and then groups of three behind points.
bool may_be_thousands(std::string_view cell) {
  const char *p = cell.data(), *const end = p + cell.size();
  while (p != end && (*p == ' ' || *p == '-' || *p == '+')) ++p;
  const char* const first = p;
  while (p != end && is_digit(*p)) ++p;
  if (p == first || p - first > 3 || *first == '0') return false;
  for (; p != end && *p == '.'; p += 4)
    if (!is_group(p + 1, end)) return false;
  while (p != end && *p == ' ') ++p;
  return p == end;
}

}  // namespace

void CsvCursor::look_for_thousands(const char* from, const char* to) {
  if (!comma_seen_) comma_seen_ = std::find(from, to, ',') != to;
  if (thousands_.line > 0) return;
  const auto ends_cell = [this](char c) { return c == separator_ || c == '\r' || c == '\n'; };
  for (const char* p = std::find(from, to, '.'); p != to; p = std::find(p + 1, to, '.')) {
    if (!is_group(p + 1, to)) continue;
    const char *first = p, *const last = std::find_if(p, to, ends_cell);
    while (first != from && first[-1] != separator_) --first;
    if (!may_be_thousands({first, static_cast<std::size_t>(last - first)})) continue;
    thousands_ = {line_, std::string(first, last)};
    return;
  }
}

bool CsvCursor::row_ended_by_file() const {
  return p_ == end_ && cell_end_ &&
         std::find_if(cell_end_, end_, [](char c) { return c == '\n' || c == '\r'; }) == end_;
}

std::size_t CsvCursor::bytes_taken() const { return dropped_ + static_cast<std::size_t>(p_ - buffer_.data()); }

std::string CsvCursor::last_text() const {
  constexpr std::size_t longest = 40;
  std::string text(cell_, cell_end_);
  if (text.size() > longest) text = text.substr(0, longest) + "...";
  return text;
}

void append_number(std::string& to, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  to.append(buffer, result.ptr);
}

void append_cell(std::string& to, std::string_view cell) {
  const bool quote = cell.find_first_of(",;\t\"\r\n") != std::string_view::npos || cell.starts_with('#') ||
                     cell.starts_with(' ') || cell.ends_with(' ');
  if (!quote) {
    to += cell;
    return;
  }
  to += '"';
  for (char c : cell) {
    if (c == '"') to += '"';
    to += c;
  }
  to += '"';
}

}  // namespace servodx
