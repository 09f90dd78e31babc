#include "fit/tuning_comments.h"

#include <algorithm>
#include <cctype>
#include <string_view>

#include "servodx/log.h"
#include "signals/signal.h"

namespace servodx {
namespace {

enum class TuningLine { none, average, error, tuned_by };

bool is_hash(std::string_view word) {
  constexpr std::size_t sha256_digits = 64;
  return word.size() == sha256_digits &&
         std::all_of(word.begin(), word.end(), [](unsigned char c) { return std::isxdigit(c) != 0; });
}

// What follows the key and one space; nothing where the line begins otherwise.
std::string_view after(std::string_view line, std::string_view key) {
  if (!line.starts_with(key) || line.size() <= key.size() + 1 || line[key.size()] != ' ') return {};
  return line.substr(key.size() + 1);
}

TuningLine kind_of(std::string_view line) {
  if (line.starts_with(std::string(average_key) + ": ")) return TuningLine::average;
  const std::string_view error = after(line, error_key), hash = after(line, tuned_by_key);
  if (const std::size_t colon = error.find(':');
      colon != std::string_view::npos && find_signal(error.substr(0, colon)))
    return TuningLine::error;
  // A log made in memory may have no hash: two spaces follow the key.
  if (!hash.empty() && (hash.front() == ' ' || is_hash(hash.substr(0, hash.find(' '))))) return TuningLine::tuned_by;
  return TuningLine::none;
}

}  // namespace

std::vector<std::string> newest_tuning(const std::vector<std::string>& comments) {
  std::vector<std::string> set;
  TuningLine last = TuningLine::none;
  for (const std::string& line : comments) {
    const TuningLine kind = kind_of(line);
    if (kind == TuningLine::none) continue;
    if (last == TuningLine::tuned_by && kind != TuningLine::tuned_by) set.clear();  // the next set begins
    set.push_back(line);
    last = kind;
  }
  return set;
}

std::vector<std::string> without_tunings(const std::vector<std::string>& comments) {
  std::vector<std::string> kept;
  for (const std::string& line : comments)
    if (kind_of(line) == TuningLine::none) kept.push_back(line);
  return kept;
}

}  // namespace servodx
