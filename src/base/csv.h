// CSV text: a cursor that walks rows and cells of a file held in memory once, and the few words needed to write one.
//
// Reads: separator ',' ';' or tab (the most frequent in the header line), decimal comma in numbers where the separator
// is ';', UTF-8 BOM, LF and CRLF, '#' comment lines before the header, blank lines anywhere, RFC 4180 quoted cells
// (which may hold separators, doubled quotes and line ends). Spaces around a cell are dropped.
// Leaves out: UTF-16 (refused), thousands separators, escapes other than doubled quotes.
//
// No library: fast-cpp-csv-parser fixes separator and quoting at compile time, parses with its own float loop (not
// correctly rounded) and throws its own errors, where logs need a sniffed separator and exact round trips.
// std::from_chars is correctly rounded and as fast as fast_float, from which libstdc++ takes it.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace servodx {

// Whole file in one read. Throws InputError where it cannot be opened, is a folder, or is not readable.
std::string read_file(const std::string& path);

enum class Cell { number, missing, text, none };  // missing: empty or NaN; none: the row has no further cell

class CsvCursor {
 public:
  // `text` must outlive the cursor; `path` is for errors. Reads comments and the header line.
  CsvCursor(std::string_view text, std::string path);

  const std::vector<std::string>& header() const { return header_; }
  long header_line() const { return header_line_; }
  const std::vector<std::string>& comments() const { return comments_; }  // without '#' and one space after it
  char separator() const { return separator_; }

  bool next_row();                     // to the next line that is not blank; skips what is left of this one
  bool next_cell(std::string& text);   // false: the row has no further cell
  Cell next_number(double& value);     // NaN for missing; a finite number, or text (see last_text)
  bool skip_cell();                    // like next_cell, without the text
  long line() const { return line_; }  // 1-based line on which the row began
  bool row_ended_by_file() const;      // after the row's last cell: no line end followed it
  std::string last_text() const;       // the cell just read, as written, shortened

 private:
  bool at_row_end() const { return p_ == end_ || *p_ == '\n' || (*p_ == '\r' && (p_ + 1 == end_ || p_[1] == '\n')); }
  bool is_blank(char c) const { return c == ' ' || (c == '\t' && separator_ != '\t'); }
  void finish_cell();
  void count_line_ends(const char* from, const char* to);

  std::string path_;
  const char* p_ = nullptr;
  const char* end_ = nullptr;
  const char* cell_ = nullptr;      // start of the cell just read
  const char* cell_end_ = nullptr;  // its end
  bool in_row_ = false;
  bool more_ = false;  // a further cell follows in this row
  char separator_ = ',';
  long line_ = 0;
  long next_line_ = 1;
  long header_line_ = 0;
  std::vector<std::string> header_;
  std::vector<std::string> comments_;
};

void append_number(std::string& to, double value);         // shortest digits that read back to the same bits
void append_cell(std::string& to, std::string_view cell);  // quoted where RFC 4180 asks for it

}  // namespace servodx
