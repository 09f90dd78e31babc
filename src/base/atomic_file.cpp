#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"

namespace servodx {

namespace {

// Takes away the temporary file of a writer that is gone; false: somebody holds it, or it cannot be told.
bool take_away(const std::string& temporary) {
  const int fd = ::open(temporary.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (fd < 0) return errno == ENOENT;
  struct stat held {
  }, named{};
  const bool free = ::flock(fd, LOCK_EX | LOCK_NB) == 0 && ::fstat(fd, &held) == 0;
  // Under the lock the name cannot come to mean another file, where it means this one.
  if (free && ::stat(temporary.c_str(), &named) == 0 && named.st_ino == held.st_ino && named.st_dev == held.st_dev)
    ::unlink(temporary.c_str());
  ::close(fd);
  return free;
}

}  // namespace

std::string end_of_links(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int most_links = 40;  // as the kernel follows
  std::error_code none;
  fs::path end = path;
  for (int i = 0; i < most_links && fs::is_symlink(end, none); ++i) {
    const fs::path next = fs::read_symlink(end, none);
    if (none || next.empty()) break;
    end = end.parent_path() / next;  // an absolute one replaces all
  }
  return end.string();
}

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(end_of_links(path)) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  const auto refuse = [&](const std::string& why, const std::string& mend) {
    throw InputError({path_, 0, ""}, "cannot be written: " + why, mend);
  };
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) refuse("it is a folder", "name a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fd_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    open_temporary();
    if (fd_ >= 0 && fs::exists(status)) ::fchmod(fd_, static_cast<mode_t>(status.permissions()));
  }
  if (fd_ < 0) refuse(std::strerror(errno), "check that the folder exists and may be written");
}

void AtomicFile::open_temporary() {
  constexpr int most_writers = 1000;  // of one target at once
  for (int i = 0; i < most_writers;) {
    temporary_ = target_ + ".servodx-tmp" + std::to_string(i);
    fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd_ < 0 && errno != EEXIST) return;
    if (fd_ < 0) {
      if (!take_away(temporary_)) ++i;
      continue;
    }
    ::flock(fd_, LOCK_EX);  // a file system without locks writes all the same
    struct stat status {};
    if (::fstat(fd_, &status) != 0 || status.st_nlink > 0) return;
    ::close(fd_);  // taken for a leftover before it was locked
  }
  fd_ = -1;
  errno = EBUSY;
}

AtomicFile::~AtomicFile() {
  if (fd_ < 0) return;
  ::close(fd_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(const std::string& what) const {
  throw std::runtime_error(path_ + ": " + what + ": " + std::strerror(errno));
}

void AtomicFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd_, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("cannot be written");
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

void AtomicFile::commit() {
  if (temporary_.empty()) {
    const int fd = fd_;
    fd_ = -1;
    if (::close(fd) != 0) fail("cannot be closed");
    return;
  }
  if (::fsync(fd_) != 0) fail("cannot be synced");
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) fail("cannot be renamed into place");
  ::close(fd_);
  fd_ = -1;
  sync_folder();
}

bool AtomicFile::commit_new() {
  if (::fsync(fd_) != 0) fail("cannot be synced");
  const char *const from = temporary_.c_str(), *const to = target_.c_str();
  const bool made = ::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0;
  if (!made && errno == EEXIST) return false;
  // A file system that cannot tell: two first writers at once are then told apart by neither.
  if (!made && ::rename(from, to) != 0) fail("cannot be renamed into place");
  ::close(fd_);
  fd_ = -1;
  sync_folder();
  return true;
}

// A rename is durable once the folder is synced; a file system that cannot do so has still renamed.
void AtomicFile::sync_folder() const {
  const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
  const int dir = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (dir < 0) return;
  ::fsync(dir);
  ::close(dir);
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace servodx
