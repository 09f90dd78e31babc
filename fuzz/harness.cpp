#include "harness.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace servodx::fuzz {
namespace {

namespace fs = std::filesystem;

// A target that cannot give its input tests nothing.
void require(bool done, const char* what) {
  if (done) return;
  std::perror(what);
  std::abort();
}

void write_whole(int file, std::string_view bytes) {
  require(::ftruncate(file, 0) == 0, "ftruncate");
  require(::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()), "pwrite");
}

std::string made_folder() {
  std::string name = "/dev/shm/servodx-fuzz-XXXXXX";
  require(::mkdtemp(name.data()) != nullptr, "mkdtemp");
  static std::string made;
  made = name;
  std::atexit([] {
    std::error_code ignored;
    fs::remove_all(made, ignored);
  });
  return name;
}

}  // namespace

InputFile::InputFile(std::string_view bytes) {
  static const int file = ::memfd_create("input", 0);
  require(file >= 0, "memfd_create");
  write_whole(file, bytes);
  path_ = fmt::format("/proc/self/fd/{}", file);
}

InputFolder::InputFolder() {
  static const std::string folder = made_folder();
  path_ = folder;
  for (const auto& entry : fs::directory_iterator(path_)) fs::remove_all(entry.path());
}

std::string InputFolder::write(const std::string& name, std::string_view bytes) const {
  const std::string file = path_ + "/" + name;
  const int made = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  require(made >= 0, "open");
  write_whole(made, bytes);
  ::close(made);
  return file;
}

}  // namespace servodx::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  servodx::fuzz::refusing([&] { servodx::fuzz::read({reinterpret_cast<const char*>(bytes), size}); });
  return 0;
}
