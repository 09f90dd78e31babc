// The logs of a fleet as a text file: one path a line, relative to the working directory as on the command line.
//
// Blank lines and lines that begin with '#' are skipped; blanks around a path are dropped. Only the paths are kept.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace servodx {

// Every `of`-th log from the `part`-th on: the shares of several processes meet nowhere and leave nothing out.
struct Chunk {
  std::size_t part = 1, of = 1;  // part 1..of
};

// "3/20". Throws InputError naming --chunk.
Chunk read_chunk(const std::string& text);

bool is_standard_input(const std::string& path);  // "-"

// Throws InputError where it cannot be read or names no log; a chunk may be empty.
std::vector<std::string> read_log_list(const std::string& path, const Chunk& chunk = {});

}  // namespace servodx
