#include "base/checkpoint.h"

#include <fcntl.h>
#include <link.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <utility>

#include "base/csv.h"
#include "base/error.h"
#include "base/sha256.h"

namespace servodx {
namespace {

constexpr std::string_view first_line = "servodx checkpoint 1\n";
constexpr std::string_view stage_word = "stage ";
constexpr std::size_t hash_length = 64;  // of SHA-256 in hex

std::string hash_of(std::string_view key, std::string_view bytes) {
  Sha256 hash;
  hash.add(key);
  hash.add(bytes);
  return hash.hex();
}

// The next stage of `text`, which becomes what follows it. False where it is not whole.
bool take_stage(std::string_view& text, CheckpointText& out) {
  std::string_view rest = text;
  const auto word = [&](std::size_t length) {
    const std::string_view taken = rest.substr(0, length);
    rest.remove_prefix(taken.size());
    return taken;
  };
  const auto mark = [&](char c) { return word(1) == std::string_view(&c, 1); };
  if (word(stage_word.size()) != stage_word) return false;
  const std::string_view key = word(hash_length);
  if (key.size() < hash_length || !mark(' ')) return false;
  std::size_t length = 0;
  const auto [end, failed] = std::from_chars(rest.data(), rest.data() + rest.size(), length);
  if (failed != std::errc()) return false;
  word(static_cast<std::size_t>(end - rest.data()));
  if (!mark(' ')) return false;
  const std::string_view hash = word(hash_length);
  if (!mark('\n') || length > rest.size()) return false;
  const std::string_view bytes = word(length);
  if (!mark('\n') || hash_of(key, bytes) != hash) return false;
  out.stages.insert_or_assign(std::string(key), std::string(bytes));
  text = rest;
  return true;
}

// All of it, or as much as the disk takes.
bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  return true;
}

}  // namespace

CheckpointText parse_checkpoint(std::string_view text) {
  CheckpointText out;
  if (!text.starts_with(first_line)) {
    out.kind = first_line.starts_with(text) ? CheckpointText::Kind::begun : CheckpointText::Kind::foreign;
    return out;
  }
  out.kind = CheckpointText::Kind::ours;
  std::string_view rest = text.substr(first_line.size());
  while (take_stage(rest, out)) {
  }
  out.sound = text.size() - rest.size();
  return out;
}

std::string stage_text(std::string_view key, std::string_view bytes) {
  std::string text(stage_word);
  text.append(key)
      .append(" ")
      .append(std::to_string(bytes.size()))
      .append(" ")
      .append(hash_of(key, bytes))
      .append("\n");
  return text.append(bytes).append("\n");
}

Checkpoint::Checkpoint(std::string path, CheckpointUse use, std::string build)
    : path_(std::move(path)), build_(std::move(build)) {
  try {
    open(use);
  } catch (...) {
    if (fd_ >= 0) ::close(fd_);
    throw;
  }
}

Checkpoint::~Checkpoint() { ::close(fd_); }

void Checkpoint::open(CheckpointUse use) {
  const auto refuse = [&](const std::string& why, const std::string& mend) {
    throw InputError({path_, 0, ""}, why, mend);
  };
  const bool begins = use == CheckpointUse::begin;
  fd_ = ::open(path_.c_str(), O_RDWR | O_CLOEXEC | (begins ? O_CREAT : 0), 0666);
  if (fd_ < 0 && errno == ENOENT && !begins) refuse("is not there to resume from", "leave out --resume to begin");
  if (fd_ < 0) refuse(std::string("cannot be written: ") + std::strerror(errno), "name another file");
  struct stat status {};
  if (::fstat(fd_, &status) != 0 || !S_ISREG(status.st_mode))
    refuse("is no file that a checkpoint can be kept in", "name another file");
  if (::flock(fd_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    refuse("is the checkpoint of another run at this moment", "wait for that run, or name another file");
  if (!begins) {
    const std::string text = read_file(path_);
    CheckpointText read = parse_checkpoint(text);
    if (read.kind == CheckpointText::Kind::foreign)
      refuse("is no checkpoint of this version", "start without --resume, or give the file that the run wrote");
    if (read.sound < text.size() && read.kind == CheckpointText::Kind::ours)
      report_.trouble = "its last " + std::to_string(text.size() - read.sound) +
                        " bytes are no whole stage and are left out: what they held is made again";
    stages_ = std::move(read.stages);
    end_ = read.sound;
  }
  if (::ftruncate(fd_, static_cast<off_t>(end_)) != 0 || ::lseek(fd_, 0, SEEK_END) < 0)
    refuse(std::string("cannot be written: ") + std::strerror(errno), "name another file");
  if (end_ == 0) append(first_line);
}

// What the disk does not take whole is taken back; the run goes on.
void Checkpoint::append(std::string_view text) {
  if (full_) return;
  if (write_all(fd_, text)) {
    end_ += text.size();
    return;
  }
  full_ = true;
  report_.trouble = std::string("cannot be written (") + std::strerror(errno) + "): no more is kept";
  if (::ftruncate(fd_, static_cast<off_t>(end_)) == 0) ::lseek(fd_, 0, SEEK_END);
}

std::optional<std::string> Checkpoint::find(std::string_view key) const {
  const std::lock_guard lock(mutex_);
  const auto at = stages_.find(key);
  if (at == stages_.end()) return {};
  ++report_.taken;
  return at->second;
}

void Checkpoint::keep(std::string_view key, std::string_view bytes) {
  const std::string text = stage_text(key, bytes);
  const std::lock_guard lock(mutex_);
  append(text);
  if (!full_) ++report_.kept;
}

CheckpointReport Checkpoint::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

namespace {

struct BuildSought {
  std::uintptr_t here;  // an address in the object that is meant
  std::string found;
};

std::string hex(const unsigned char* bytes, std::size_t count) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string out;
  for (std::size_t i = 0; i < count; ++i) out += digits[bytes[i] >> 4], out += digits[bytes[i] & 15];
  return out;
}

constexpr std::size_t whole_words(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

// The note NT_GNU_BUILD_ID among those of a segment.
std::string build_id_among(const unsigned char* notes, std::size_t size) {
  while (size >= sizeof(ElfW(Nhdr))) {
    ElfW(Nhdr) head;
    std::memcpy(&head, notes, sizeof head);
    const std::size_t name = whole_words(head.n_namesz), text = whole_words(head.n_descsz);
    if (sizeof head + name + text > size) break;
    const unsigned char* const at = notes + sizeof head;
    if (head.n_type == NT_GNU_BUILD_ID && head.n_namesz == 4 && std::memcmp(at, "GNU", 4) == 0)
      return hex(at + name, head.n_descsz);
    notes += sizeof head + name + text, size -= sizeof head + name + text;
  }
  return {};
}

int look_at_object(dl_phdr_info* object, std::size_t, void* data) {
  auto& sought = *static_cast<BuildSought*>(data);
  bool is_here = false;
  std::string found;
  for (int i = 0; i < object->dlpi_phnum; ++i) {
    const auto& part = object->dlpi_phdr[i];
    const std::uintptr_t from = object->dlpi_addr + part.p_vaddr;
    if (part.p_type == PT_LOAD) is_here = is_here || (sought.here >= from && sought.here < from + part.p_memsz);
    if (part.p_type == PT_NOTE && found.empty())
      found = build_id_among(reinterpret_cast<const unsigned char*>(from), part.p_memsz);
  }
  if (is_here) sought.found = found;
  return is_here;
}

}  // namespace

std::string build_identity() {
  BuildSought sought{reinterpret_cast<std::uintptr_t>(&look_at_object), {}};
  ::dl_iterate_phdr(look_at_object, &sought);
  return sought.found;
}

}  // namespace servodx
