// A file that appears whole or not at all: written under a temporary name in the same folder, synced, renamed.
//
// Where the target exists and is no regular file (/dev/null, a pipe) it is written directly. A target that is a link
// keeps the link and replaces, or makes, what it points to. The opening refusal is an InputError (a wrong path is the
// caller's); a failing write or rename is std::runtime_error.
// The writer holds a lock on its temporary file. One that nobody holds was left by a kill; the next writer of the same
// target takes it away.
#pragma once
#include <string>
#include <string_view>

namespace servodx {

// Where `path` is written: the end of its links, be it there or not.
std::string end_of_links(const std::string& path);

class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path);
  ~AtomicFile();  // without commit(): the temporary file is removed and the target is as before
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // For a library that writes by name; close there before commit. Empty: the target is written directly.
  const std::string& temporary() const { return temporary_; }
  void write(std::string_view bytes);
  void commit();
  bool commit_new();  // false: somebody else made the target meanwhile, which stays as it is

 private:
  [[noreturn]] void fail(const std::string& what) const;
  void open_temporary();
  void sync_folder() const;
  std::string path_;       // as given, for errors
  std::string target_;     // links resolved
  std::string temporary_;  // empty: written directly
  int fd_ = -1;
};

void write_file(const std::string& path, std::string_view bytes);

}  // namespace servodx
