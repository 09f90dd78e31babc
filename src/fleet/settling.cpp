#include "fleet/settling.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.h"
#include "base/small_letters.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;

bool is_log(const fs::path& path) {
  constexpr std::array<std::string_view, 5> endings = {".csv", ".txt", ".tsv", ".dat", ".mat"};
  const std::string ending = in_small_letters(path.extension().string());
  return path.filename().string().front() != '.' && std::find(endings.begin(), endings.end(), ending) != endings.end();
}

}  // namespace

std::vector<SeenFile> logs_in(const std::string& folder) {
  std::error_code failed;
  std::vector<SeenFile> seen;
  fs::directory_iterator entry(folder, failed);
  for (const fs::directory_iterator end; !failed && entry != end; entry.increment(failed)) {
    std::error_code gone;  // a file may go between two looks
    if (!entry->is_regular_file(gone) || !is_log(entry->path())) continue;
    SeenFile file{entry->path().filename().string(), entry->file_size(gone), {}};
    if (!gone) file.time = entry->last_write_time(gone);
    if (!gone) seen.push_back(std::move(file));
  }
  if (failed) throw InputError({folder, 0, ""}, "cannot be read as a folder", "name the folder that logs come into");
  std::sort(seen.begin(), seen.end(), [](const SeenFile& a, const SeenFile& b) { return a.name < b.name; });
  return seen;
}

std::vector<std::string> Settling::settled(const std::vector<SeenFile>& seen, double now) {
  std::map<std::string, State> states;
  std::vector<std::string> names;
  for (const SeenFile& file : seen) {
    State state{file.size, file.time, now};
    if (const auto last = states_.find(file.name);
        last != states_.end() && last->second.size == file.size && last->second.time == file.time)
      state = last->second;
    if (!state.named && now - state.since >= seconds_) {
      state.named = true;
      names.push_back(file.name);
    }
    states.emplace(file.name, state);
  }
  states_ = std::move(states);
  return names;
}

std::size_t Settling::unsettled() const {
  return static_cast<std::size_t>(
      std::count_if(states_.begin(), states_.end(), [](const auto& each) { return !each.second.named; }));
}

}  // namespace servodx
