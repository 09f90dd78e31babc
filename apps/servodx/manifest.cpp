#include "manifest.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/json_text.h"
#include "base/reading_limits.h"
#include "base/sha256.h"

namespace servodx {

void without_wall_time(nlohmann::ordered_json& json) {
  if (json.is_object())
    for (const char* key : {"seconds", "cost_in_step", "cost_in_batch", "real_time_factor"}) json.erase(key);
  if (json.is_structured())
    for (auto& item : json) without_wall_time(item);
}

std::string fingerprint(const std::string& bytes) {
  auto json = json_or_discarded<nlohmann::ordered_json>(bytes);
  if (!json.is_object() || !json.contains("seconds")) return sha256(bytes);
  without_wall_time(json);
  return sha256(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

std::vector<std::string> inputs_of_manifest(const std::string& path) {
  namespace fs = std::filesystem;
  std::vector<std::string> out;
  std::error_code absent;
  if (!fs::is_regular_file(path, absent)) return out;
  const auto manifest = json_or_discarded<nlohmann::ordered_json>(read_file_within(path, largest_json));
  if (!manifest.is_object() || !manifest.contains("inputs") || !manifest["inputs"].is_array()) return out;
  if (!manifest.contains("directory") || !manifest["directory"].is_string()) return out;
  const fs::path from = fs::path(path).parent_path() / manifest["directory"].get<std::string>();
  for (const auto& input : manifest["inputs"])
    if (input.is_object() && input.contains("path") && input["path"].is_string())
      out.push_back((from / input["path"].get<std::string>()).lexically_normal().string());
  return out;
}

}  // namespace servodx
