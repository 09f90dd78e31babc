// The end of a file that another process writes, or standard input: bytes as they come.
//
// A file that was cut short, or replaced by another of its name, begins anew. Reading waits at most as long as it is
// told, so that a caller can be stopped.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace servodx {

// "-" in place of a path: standard input, or output.
inline bool is_standard_stream(std::string_view path) { return path.size() == 1 && path.front() == '-'; }

class ByteTail {
 public:
  // "-": standard input. Throws InputError where the file cannot be opened. `from`: bytes that are passed over; a file
  // that is shorter is read from its beginning. Standard input has no place to go back to.
  explicit ByteTail(std::string path, std::uint64_t from = 0);
  ~ByteTail();
  ByteTail(const ByteTail&) = delete;
  ByteTail& operator=(const ByteTail&) = delete;

  struct Read {
    std::string bytes;
    bool began_anew = false;  // the bytes are another file's: what was half read is void
    bool ended = false;       // standard input was closed: nothing will come
  };
  // Waits up to `seconds` for bytes; empty where none came.
  Read next(double seconds);
  std::uint64_t position() const { return position_; }  // bytes taken of this file

 private:
  bool replaced();
  void open();

  std::string path_;
  int fd_ = -1;
  std::uint64_t position_ = 0, file_id_ = 0;
};

}  // namespace servodx
