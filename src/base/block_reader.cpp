#include "base/block_reader.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

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
  reader_ = std::thread([this] { read_ahead(); });
}

BlockReader::~BlockReader() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  reader_.join();
  ::close(fd_);
}

void BlockReader::read_ahead() {
  try {
    Sha256 hash;
    while (true) {
      {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return stop_ || filled_ - taken_ < blocks; });
        if (stop_) return;
      }
      std::string& block = block_[filled_ % blocks];
      block.resize(block_size);
      std::size_t size = 0;
      while (size < block_size) {
        const ssize_t got = ::read(fd_, block.data() + size, block_size - size);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) refuse(path_, std::strerror(errno));
        if (got == 0) break;
        size += static_cast<std::size_t>(got);
      }
      block.resize(size);
      hash.add(block);
      const std::lock_guard lock(mutex_);
      ++filled_;
      if (size < block_size) {
        sha256_ = hash.hex();
        end_ = true;
        changed_.notify_all();
        return;
      }
      changed_.notify_all();
    }
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
