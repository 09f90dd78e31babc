#include "base/block_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/error.h"
#include "base/sha256.h"

namespace servodx {
namespace {

constexpr std::size_t block_size = std::size_t{1} << 18;  // stays in a core's cache

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError({path, 0, ""}, "cannot be read: " + why, "check the path and its permissions");
}

}  // namespace

BlockReader::BlockReader(std::string path) : path_(std::move(path)) {
  fd_ = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status {};
  if (fd_ < 0 || ::fstat(fd_, &status) != 0 || S_ISDIR(status.st_mode)) {
    const std::string why = fd_ >= 0 && S_ISDIR(status.st_mode) ? "it is a folder" : std::strerror(errno);
    if (fd_ >= 0) ::close(fd_);
    refuse(path_, why);
  }
  if (S_ISREG(status.st_mode)) size_ = static_cast<std::size_t>(status.st_size);
  // A file of one block is read at once: a thread takes longer to begin than that.
  try {
    const bool more = size_ == 0 || size_ >= block_size || read_block();
    if (more) reader_ = std::thread([this] { read_ahead(); });
  } catch (...) {
    ::close(fd_);
    throw;
  }
}

BlockReader::~BlockReader() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  if (reader_.joinable()) reader_.join();
  ::close(fd_);
}

bool BlockReader::read_block() {
  std::string& block = block_[filled_ % blocks];
  block.resize(size_ > 0 ? std::min(block_size, size_ + 1) : block_size);
  std::size_t size = 0;
  while (size < block.size()) {
    const ssize_t got = ::read(fd_, block.data() + size, block.size() - size);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) refuse(path_, std::strerror(errno));
    if (got == 0) break;
    size += static_cast<std::size_t>(got);
  }
  const bool last = size < block.size();
  block.resize(size);
  hash_.add(block);
  const std::lock_guard lock(mutex_);
  ++filled_;
  if (last) {
    sha256_ = hash_.hex();
    end_ = true;
  }
  changed_.notify_all();
  return !last;
}

void BlockReader::read_ahead() {
  try {
    do {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return stop_ || filled_ - taken_ < blocks; });
      if (stop_) return;
    } while (read_block());
  } catch (...) {
    const std::lock_guard lock(mutex_);
    error_ = std::current_exception();
    changed_.notify_all();
  }
}

std::string_view BlockReader::next() {
  std::unique_lock lock(mutex_);
  if (given_) {
    ++taken_;
    given_ = false;
    changed_.notify_all();
  }
  changed_.wait(lock, [&] { return filled_ > taken_ || end_ || error_; });
  if (error_) std::rethrow_exception(error_);
  if (filled_ == taken_) return {};
  given_ = true;
  return block_[taken_ % blocks];
}

std::string BlockReader::sha256() {
  while (!next().empty()) {
  }
  return sha256_;
}

}  // namespace servodx
