// What every fuzz target shares: one input, given to readers that may refuse it and may do nothing else.
//
// A target is one file that defines read(). An InputError that leaves it is a refusal; any other exception, and
// whatever a sanitizer finds, ends the target. Targets are built by `cmake --preset fuzz` and run by scripts/fuzz.
#pragma once
#include <string>
#include <string_view>

#include "base/error.h"

namespace servodx::fuzz {

void read(std::string_view input);

// The input as a file in memory, for readers that take a path. One a process: a second one takes the first one's place.
class InputFile {
 public:
  explicit InputFile(std::string_view bytes);
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A folder in memory for readers that look beside a file; emptied when it is made.
class InputFolder {
 public:
  InputFolder();
  std::string write(const std::string& name, std::string_view bytes) const;  // its path
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// Runs one reader of several: what it refuses is not kept from the next.
template <class Reader>
void refusing(const Reader& reader) {
  try {
    reader();
  } catch (const InputError&) {
  }
}

}  // namespace servodx::fuzz
