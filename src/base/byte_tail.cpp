#include "base/byte_tail.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>
#include <utility>

#include "base/error.h"

namespace servodx {
namespace {

constexpr std::size_t most_at_once = std::size_t{1} << 16;  // [bytes]
constexpr double between_looks = 0.005;                     // [s] at a file: a quarter of what an alarm may take

}  // namespace

ByteTail::ByteTail(std::string path, std::uint64_t from) : path_(std::move(path)) {
  if (is_standard_stream(path_)) {
    fd_ = STDIN_FILENO;
    return;
  }
  open();
  struct stat now {};
  if (fstat(fd_, &now) == 0 && static_cast<std::uint64_t>(now.st_size) >= from) position_ = from;
}

ByteTail::~ByteTail() {
  if (fd_ > STDIN_FILENO) ::close(fd_);
}

void ByteTail::open() {
  const int fd = ::open(path_.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat now {};
  if (fd < 0 || fstat(fd, &now) != 0 || S_ISDIR(now.st_mode)) {
    const std::string reason = fd < 0 ? std::strerror(errno) : "is a folder";
    if (fd >= 0) ::close(fd);
    throw InputError({.file = path_}, "cannot be read: " + reason, "name a file that grows, or - for standard input");
  }
  if (fd_ > STDIN_FILENO) ::close(fd_);
  fd_ = fd;
  file_id_ = static_cast<std::uint64_t>(now.st_ino);
  position_ = 0;
}

bool ByteTail::replaced() {
  struct stat here {
  }, named{};
  if (fstat(fd_, &here) != 0) return false;
  if (static_cast<std::uint64_t>(here.st_size) < position_) return true;
  // What is left of the old file is read first.
  if (static_cast<std::uint64_t>(here.st_size) > position_) return false;
  return stat(path_.c_str(), &named) == 0 && static_cast<std::uint64_t>(named.st_ino) != file_id_;
}

ByteTail::Read ByteTail::next(double seconds) {
  Read out;
  out.bytes.resize(most_at_once);
  const bool input = is_standard_stream(path_);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (;;) {
    ssize_t got = 0;
    if (input) {
      pollfd wait{fd_, POLLIN, 0};
      const int ready = ::poll(&wait, 1, static_cast<int>(seconds * 1e3));
      if (ready > 0) got = ::read(fd_, out.bytes.data(), out.bytes.size());
      out.ended = ready > 0 && got == 0;
    } else {
      if (replaced()) {
        open();
        out.began_anew = true;
      }
      got = ::pread(fd_, out.bytes.data(), out.bytes.size(), static_cast<off_t>(position_));
    }
    if (got < 0 && errno != EINTR && errno != EAGAIN)
      throw std::runtime_error(path_ + ": cannot be read: " + std::strerror(errno));
    if (got > 0 || input || std::chrono::steady_clock::now() >= end) {
      out.bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
      position_ += out.bytes.size();
      return out;
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(std::min(between_looks, seconds)));
  }
}

}  // namespace servodx
