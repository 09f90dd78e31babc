// Rows of text cells with aligned columns, for a fixed-width terminal.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace servodx::report {

class Columns {
 public:
  // One letter a column: 'l' left, 'r' right. `indent` spaces lead each line, two stand between columns.
  explicit Columns(std::string alignment, int indent = 0) : alignment_(std::move(alignment)), indent_(indent) {}

  void row(std::vector<std::string> cells);  // further cells than columns are an error; fewer are blank
  std::string text() const;                  // no line ends in blanks

 private:
  std::string alignment_;
  int indent_;
  std::vector<std::vector<std::string>> rows_;
};

std::string join(const std::vector<std::string>& words, std::string_view between = ", ");

}  // namespace servodx::report
