#include "fleet/log_list.h"

#include <charconv>
#include <fstream>
#include <iostream>
#include <system_error>

#include "base/error.h"

namespace servodx {
namespace {

std::string without_blanks(const std::string& line) {
  constexpr const char* blanks = " \t\r";
  const auto from = line.find_first_not_of(blanks);
  return from == std::string::npos ? "" : line.substr(from, line.find_last_not_of(blanks) - from + 1);
}

bool read_count(const std::string& text, std::size_t& count) {
  const char* const end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, count);
  return error == std::errc() && at == end && count > 0;
}

}  // namespace

bool is_standard_input(const std::string& path) { return path == "-"; }

Chunk read_chunk(const std::string& text) {
  Chunk chunk;
  const auto slash = text.find('/');
  const bool read = slash != std::string::npos && read_count(text.substr(0, slash), chunk.part) &&
                    read_count(text.substr(slash + 1), chunk.of) && chunk.part <= chunk.of;
  if (!read)
    throw InputError({"--chunk", 0, ""}, "'" + text + "' is no part of a whole", "1/20 is the first of twenty");
  return chunk;
}

std::vector<std::string> read_log_list(const std::string& path, const Chunk& chunk) {
  std::ifstream file;
  const bool from_file = !is_standard_input(path);
  if (from_file) file.open(path);
  std::istream& in = from_file ? file : std::cin;
  if (!in) throw InputError({path, 0, ""}, "the list cannot be read", "name a text file with one log a line");
  std::vector<std::string> logs;
  std::size_t seen = 0;
  for (std::string line; std::getline(in, line);) {
    std::string log = without_blanks(line);
    if (log.empty() || log.front() == '#') continue;
    if (seen++ % chunk.of == chunk.part - 1) logs.push_back(std::move(log));
  }
  if (in.bad() || seen == 0)
    throw InputError({path, 0, ""}, in.bad() ? "the list cannot be read" : "the list names no log",
                     "write the path of one log a line");
  return logs;
}

}  // namespace servodx
