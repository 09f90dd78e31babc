#include "base/atomic_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "base/error.h"

namespace servodx {

AtomicFile::AtomicFile(const std::string& path) : path_(path), target_(path) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (fs::is_symlink(target_, ignored)) {
    const fs::path resolved = fs::weakly_canonical(target_, ignored);
    if (!ignored && !resolved.empty()) target_ = resolved;
  }
  const auto refuse = [&](const std::string& why, const std::string& mend) {
    throw InputError({path_, 0, ""}, "cannot be written: " + why, mend);
  };
  const fs::file_status status = fs::status(target_, ignored);
  if (fs::is_directory(status)) refuse("it is a folder", "name a file");
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fd_ = ::open(target_.c_str(), O_WRONLY | O_CLOEXEC);
  } else {
    const std::string stem = target_ + ".tmp" + std::to_string(::getpid()) + "-";
    for (int i = 0; fd_ < 0 && i < 1000; ++i) {
      temporary_ = stem + std::to_string(i);
      fd_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (fd_ < 0 && errno != EEXIST) break;
    }
    if (fd_ >= 0 && fs::exists(status)) ::fchmod(fd_, static_cast<mode_t>(status.permissions()));
  }
  if (fd_ < 0) refuse(std::strerror(errno), "check that the folder exists and may be written");
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
  // The rename itself is durable once the folder is synced; a file system that cannot do so has still renamed.
  const std::filesystem::path folder = std::filesystem::path(target_).parent_path();
  const int dir = ::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (dir >= 0) {
    ::fsync(dir);
    ::close(dir);
  }
}

void write_file(const std::string& path, std::string_view bytes) {
  AtomicFile file(path);
  file.write(bytes);
  file.commit();
}

}  // namespace servodx
