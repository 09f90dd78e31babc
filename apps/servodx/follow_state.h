// What `watch --follow` keeps of itself, so that a call that was killed can be gone on with.
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "window_diagnoses.h"

namespace servodx {

// Whose watch it is: a state of another is refused.
struct FollowedBy {
  std::string source;             // the log
  std::string table, table_file;  // hashes of content and of its file; earlier versions kept the second
  std::string baseline;           // hash of its file
};

struct FollowState {
  std::string head;                // of the log: names and units
  std::uint64_t judged_until = 0;  // bytes of the log
  std::uint64_t window_from = 0;   // bytes: the last window may be read again from there
  double first_time = 0;           // [s]
  long alarms = 0;
  std::vector<DueWindow> due;
  nlohmann::json watcher;  // Watcher::state
};

void write_follow_state(const std::string& path, const FollowedBy& by, const FollowState& state);
// Nothing where no file is there. Throws InputError where it is another watch's or damaged.
std::optional<FollowState> read_follow_state(const std::string& path, const FollowedBy& by);

}  // namespace servodx
