// A file in blocks of fixed size, read ahead by a second thread and hashed on the way: what a long log costs in memory
// for its text is two blocks, and the hash costs no time where a second core is free. A file of one block needs no
// thread.
#pragma once
#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

#include "base/sha256.h"

namespace servodx {

class BlockReader {
 public:
  // Throws InputError where the file cannot be opened, is a folder, or is not readable.
  explicit BlockReader(std::string path);
  ~BlockReader();
  BlockReader(const BlockReader&) = delete;
  BlockReader& operator=(const BlockReader&) = delete;

  // The next bytes, empty at the end; valid until the next call.
  std::string_view next();
  std::string sha256();                            // of the whole file; after the end
  std::size_t file_size() const { return size_; }  // 0 where it is not known (a pipe)

 private:
  static constexpr int blocks = 2;
  void read_ahead();
  bool read_block();  // false: it was the last

  std::string path_;
  int fd_ = -1;
  std::size_t size_ = 0;
  std::string block_[blocks];
  std::size_t filled_ = 0, taken_ = 0;  // blocks read, and blocks given back
  bool end_ = false, given_ = false, stop_ = false;
  std::exception_ptr error_;
  Sha256 hash_;
  std::string sha256_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::thread reader_;  // last: it begins when all else is there
};

}  // namespace servodx
