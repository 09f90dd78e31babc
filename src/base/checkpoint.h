// The file of a checkpoint (servodx/checkpoint.h): a journal of finished stages, each appended whole.
//
//   servodx checkpoint 1
//   stage KEY LENGTH HASH     KEY: of what went in; HASH: SHA-256 of KEY and of the bytes that follow
//   ...LENGTH bytes...
//
// A stage whose hash does not fit, and all behind it, is damage: a kill or a full disk has cut it. It is left out with
// a word. Of two stages of one key the later counts. Nothing is synced: what a failing machine loses is missing or
// fails its hash, and is made again. One process writes at a time, under a lock.
#pragma once
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "servodx/checkpoint.h"

namespace servodx {

struct CheckpointText {
  enum class Kind { ours, begun, foreign };  // begun: nothing, or a part of the first line
  Kind kind = Kind::foreign;
  std::map<std::string, std::string, std::less<>> stages;  // bytes by key
  std::size_t sound = 0;                                   // bytes of the text up to its damaged end
};
CheckpointText parse_checkpoint(std::string_view text);
std::string stage_text(std::string_view key, std::string_view bytes);

class Checkpoint {
 public:
  // `build`: told apart from every other that may come to other bits.
  Checkpoint(std::string path, CheckpointUse use, std::string build);
  ~Checkpoint();
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;

  const std::string& path() const { return path_; }
  const std::string& build() const { return build_; }
  // From any thread.
  std::optional<std::string> find(std::string_view key) const;
  void keep(std::string_view key, std::string_view bytes);
  CheckpointReport report() const;

 private:
  void open(CheckpointUse use);
  void append(std::string_view text);
  std::string path_, build_;
  int fd_ = -1;
  mutable std::mutex mutex_;
  std::map<std::string, std::string, std::less<>> stages_;
  std::size_t end_ = 0;  // of the file
  bool full_ = false;    // it could not be written: no more is kept
  mutable CheckpointReport report_;
};

// Of the program or library that holds this code: the linker's hash of all of it. Empty where it was linked without.
std::string build_identity();

}  // namespace servodx
