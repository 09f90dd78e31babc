// A file that appears whole or not at all: written under a temporary name in the same folder, synced, renamed.
//
// Where the target exists and is no regular file (/dev/null, a pipe) it is written directly. A target that is a link
// keeps the link and replaces what it points to. The opening refusal is an InputError (a wrong path is the caller's);
// a failing write or rename is std::runtime_error.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  // without commit(): the temporary file is removed and the target is as before
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(std::string_view bytes);
  void commit();

 private:
  [[noreturn]] void fail(const std::string& what) const;
  std::string path_;       // as given, for errors
  std::string target_;     // links resolved
  std::string temporary_;  // empty: written directly
  int fd_ = -1;
};

void write_file(const std::string& path, std::string_view bytes);

}  // namespace servodx
