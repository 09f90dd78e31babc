// Errors at the boundary: a bad input names file, line, column, the rule it breaks, and the mend.
#pragma once
#include <stdexcept>
#include <string>
#include <utility>

namespace servodx {

struct Place {
  std::string file = {};
  long line = 0;            // 1-based; 0 where no line applies
  std::string column = {};  // header name or key; empty where none applies
};

// Thrown by readers and option checks; the program prints what() and exits with code 2.
class InputError : public std::runtime_error {
 public:
  InputError(Place at, std::string broken_rule, std::string how_to_mend)
      : std::runtime_error(format(at, broken_rule, how_to_mend)),
        where(std::move(at)),
        rule(std::move(broken_rule)),
        mend(std::move(how_to_mend)) {}
  Place where;
  std::string rule;
  std::string mend;

 private:
  // "file.csv:14: column 'time': rule; mend"
  static std::string format(const Place& where, const std::string& rule, const std::string& mend) {
    std::string text = where.file;
    if (where.line > 0) {
      text += ':';
      text += std::to_string(where.line);
    }
    if (!text.empty()) text += ": ";
    if (!where.column.empty()) text += "column '" + where.column + "': ";
    text += rule;
    if (!mend.empty()) text += "; " + mend;
    return text;
  }
};

}  // namespace servodx
