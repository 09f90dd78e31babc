#include "follow_state.h"

#include <filesystem>
#include <system_error>

#include "base/atomic_file.h"
#include "base/json_text.h"
#include "servodx/error.h"

namespace servodx {
namespace {

constexpr int state_schema = 1;

FollowState state_of(const nlohmann::json& json) {
  FollowState out{.head = json.at("head"),
                  .judged_until = json.at("judged_until"),
                  .window_from = json.at("window_from"),
                  .first_time = json.at("first_time"),
                  .alarms = json.at("alarms"),
                  .due = {},
                  .watcher = json.at("watcher")};
  for (const auto& d : json.value("due", nlohmann::json::array())) out.due.push_back({d.at(0), d.at(1), d.at(2)});
  out.watcher.at("last").get<double>();  // where the watch goes on from
  return out;
}

}  // namespace

void write_follow_state(const std::string& path, const FollowedBy& by, const FollowState& state) {
  auto due = nlohmann::json::array();
  for (const DueWindow& d : state.due) due.push_back({d.of, d.begins, d.at});
  const nlohmann::ordered_json out{{"schema", state_schema},
                                   {"tool", "servodx"},
                                   {"version", SERVODX_VERSION},
                                   {"source", by.source},
                                   {"table", by.table},
                                   {"baseline", by.baseline},
                                   {"head", state.head},
                                   {"judged_until", state.judged_until},
                                   {"window_from", state.window_from},
                                   {"first_time", state.first_time},
                                   {"alarms", state.alarms},
                                   {"due", due},
                                   {"watcher", state.watcher}};
  write_file(path, out.dump() + "\n");
}

std::optional<FollowState> read_follow_state(const std::string& path, const FollowedBy& by) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return {};
  constexpr const char* mend = "remove the file to begin anew, or name another";
  const auto refusal = [&](const std::string& rule) { return InputError({.file = path}, rule, mend); };
  const auto json = json_in_file<nlohmann::json>(path, mend);
  if (!has_schema(json, state_schema)) throw refusal("is no state of a watch");
  try {
    if (json.at("source") != by.source) throw refusal("is the state of a watch of another log");
    const bool same_table = json.at("table") == by.table || json.at("table") == by.table_file;
    if (!same_table || json.at("baseline") != by.baseline) throw refusal("was saved with another table or baseline");
    return state_of(json);
  } catch (const nlohmann::json::exception&) {
    throw refusal("is damaged");
  }
}

}  // namespace servodx
