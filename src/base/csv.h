// CSV text: a cursor that walks rows and cells of a text in memory or of a file block by block, and the few words
// needed to write one.
//
// Reads: separator ',' ';' or tab (the most frequent in the header line), decimal comma in numbers where the separator
// is ';' or tab, UTF-8 BOM, LF and CRLF, '#' comment lines before the header, blank lines anywhere, RFC 4180 quoted
// cells (which may hold separators, doubled quotes and line ends). Spaces around a cell are dropped. Words of a header
// that are no UTF-8 are taken as Latin-1. Leaves out: UTF-16, lines that end in CR alone and what is no text (refused),
// escapes other than doubled quotes, thousands separators; points that may be such beside decimal commas are remembered
// for the caller to refuse.
//
// No library: fast-cpp-csv-parser fixes separator and quoting at compile time, parses with its own float loop (not
// correctly rounded) and throws its own errors, where logs need a sniffed separator and exact round trips.
// Plain decimals go by base/decimal.h, the rest by std::from_chars; both round correctly.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/decimal.h"
#include "base/error.h"

namespace servodx {

class BlockReader;

// Whole file in one read. Throws InputError where it cannot be opened, is a folder, or is not readable.
std::string read_file(const std::string& path);

enum class Cell { number, missing, text, none };  // missing: empty or NaN; none: the row has no further cell

struct CellAt {
  long line = 0;
  std::string text;
};

class CsvCursor {
 public:
  // `text` must outlive the cursor; `path` is for errors. Reads comments and the header line.
  CsvCursor(std::string_view text, std::string path);
  // The same of a file that is read as the cursor goes; holds no more of it than two blocks and the longest row.
  CsvCursor(BlockReader& file, std::string path);

  const std::vector<std::string>& header() const { return header_; }
  long header_line() const { return header_line_; }
  const std::vector<std::string>& comments() const { return comments_; }  // without '#' and one space after it
  char separator() const { return separator_; }
  bool decimal_comma() const { return point_ == ','; }
  // Takes the row that begins so many bytes ahead as the header in place of this one; its cells part at `separator`.
  void header_at(std::size_t bytes_ahead, char separator);
  // Other names for its columns, as many.
  void name_columns(std::vector<std::string> names) { header_ = std::move(names); }
  // The line of the header, empty where it is no longer in memory.
  std::string_view header_text() const;
  // Takes the last comment as the header, and the row taken for it as one to be read, where both have as many cells:
  // names behind a '#'.
  void header_from_comment();
  // What is read of the file and not yet passed; all of a text in memory.
  std::string_view ahead() const { return {p_, static_cast<std::size_t>(end_ - p_)}; }

  // All in memory from the first byte on, empty where that is passed and gone.
  std::string_view from_beginning() const;

  bool next_row();                       // to the next line that is not blank; skips what is left of this one
  std::vector<std::string> row_ahead();  // cells of the row just begun, which stays to be read
  bool next_cell(std::string& text);     // false: the row has no further cell
  // NaN for missing; a finite number, or text (see last_text).
  Cell next_number(double& value) {
    if (!in_row_ || !more_) return Cell::none;
    const char* const after = parse_decimal(p_, end_, point_, value);
    if (!after || after == end_ || (*after != separator_ && *after != '\n')) return next_odd_number(value);
    if (point_ == ',') look_for_thousands(p_, after);
    cell_ = p_;
    cell_end_ = after;
    p_ = after + 1;
    if (*after == '\n') {
      more_ = false;
      ++next_line_;
    }
    return Cell::number;
  }
  // The row's numbers at once, where it holds as many plain ones as `row` and nothing else; else nothing is read.
  bool next_plain_row(std::span<double> row) {
    if (!in_row_ || !more_) return false;
    const char *p = p_, *const end = end_;
    const char separator = separator_, point = point_;
    for (std::size_t i = 0; i < row.size(); ++i) {
      p = parse_decimal(p, end, point, row[i]);
      if (!p || p == end) return false;
      if (i + 1 < row.size() ? *p != separator : *p != '\n' && (*p != '\r' || p + 1 == end || p[1] != '\n'))
        return false;
      ++p;
    }
    if (point == ',') look_for_thousands(p_, p);
    cell_ = p_;
    cell_end_ = p - 1;
    p_ = p[-1] == '\r' ? p + 1 : p;
    more_ = false;
    ++next_line_;
    return true;
  }
  bool skip_cell();                    // like next_cell, without the text
  long line() const { return line_; }  // 1-based line on which the row began
  bool row_ended_by_file() const;      // after the row's last cell: no line end followed it
  std::size_t bytes_taken() const;     // of the file, up to the cell to come
  std::string last_text() const;       // the cell just read, as written, shortened
  // The first number whose point may part thousands, such as 57.800, where others have a decimal comma. Null: none.
  const CellAt* thousands_among_commas() const { return comma_seen_ && thousands_.line > 0 ? &thousands_ : nullptr; }

 private:
  void read_header();
  void take_header(char separator);        // 0: the most frequent in its line
  void take_header_again(char separator);  // of the same row
  Cell next_odd_number(double& value);
  void look_for_thousands(const char* from, const char* to);  // numbers of one row
  bool refill();  // more of the file behind what is left; false: there is no more
  bool row_is_whole() const { return p_ < whole_; }
  bool at_row_end() const { return p_ == end_ || *p_ == '\n' || (*p_ == '\r' && (p_ + 1 == end_ || p_[1] == '\n')); }
  bool is_blank(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }
  void finish_cell();
  void count_line_ends(const char* from, const char* to);
  [[noreturn]] void refuse_long_row(long line) const;
  void refuse_row_without_end();  // as far as a row may go on

  std::string path_;
  BlockReader* file_ = nullptr;
  std::string buffer_;           // of a file: what is not used up
  std::size_t dropped_ = 0;      // of a file: bytes before the buffer
  const char* begin_ = nullptr;  // of the text, or of the buffer
  const char* whole_ = nullptr;  // of a file: after the last line end in the buffer
  const char* p_ = nullptr;
  const char* end_ = nullptr;
  const char* row_ = nullptr;       // of a text in memory: where the row began
  const char* line_end_ = nullptr;  // of a text in memory: the row's first line end not yet passed, where looked for
  const char* cell_ = nullptr;      // start of the cell just read
  const char* cell_end_ = nullptr;  // its end
  bool in_row_ = false;
  bool more_ = false;  // a further cell follows in this row
  char separator_ = ',';
  char point_ = '.';         // accepted beside '.'
  bool comma_seen_ = false;  // in a number
  CellAt thousands_;         // line 0: none
  long line_ = 0;
  long next_line_ = 1;
  long header_line_ = 0;
  const char* header_row_ = nullptr;  // where its row begins, while that is in memory
  std::vector<std::string> header_;
  std::vector<std::string> comments_;
  long comment_line_ = 0;  // of the last
};

void append_number(std::string& to, double value);         // shortest digits that read back to the same bits
void append_cell(std::string& to, std::string_view cell);  // quoted where RFC 4180 asks for it

}  // namespace servodx
