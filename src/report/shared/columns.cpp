#include "report/shared/columns.h"

#include <algorithm>
#include <cassert>

namespace servodx::report {
namespace {

// Characters a terminal shows: bytes of UTF-8 that begin one.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

void Columns::row(std::vector<std::string> cells) {
  assert(cells.size() <= alignment_.size());
  cells.resize(alignment_.size());
  rows_.push_back(std::move(cells));
}

std::string Columns::text() const {
  std::vector<std::size_t> widest(alignment_.size(), 0);
  for (const auto& cells : rows_)
    for (std::size_t c = 0; c < cells.size(); ++c) widest[c] = std::max(widest[c], width(cells[c]));
  std::string text;
  for (const auto& cells : rows_) {
    std::string line(static_cast<std::size_t>(indent_), ' ');
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string blanks(widest[c] - width(cells[c]), ' ');
      if (c > 0) line += "  ";
      line += alignment_[c] == 'r' ? blanks + cells[c] : cells[c] + blanks;
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  }
  return text;
}

std::string join(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += between;
    text += words[i];
  }
  return text;
}

}  // namespace servodx::report
