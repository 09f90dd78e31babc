// The manifest beside a result: what was called, on what, and the fingerprints of what came of it.
#pragma once
#include <nlohmann/json.hpp>
#include <string>

#include "base/json_text.h"
#include "base/sha256.h"

namespace servodx {

inline constexpr const char* manifest_suffix = ".manifest.json";

// Takes out, at any depth, what measures this machine's time: the one thing that two runs do not share.
inline void without_wall_time(nlohmann::ordered_json& json) {
  if (json.is_object())
    for (const char* key : {"seconds", "cost_in_step", "cost_in_batch", "real_time_factor"}) json.erase(key);
  if (json.is_structured())
    for (auto& item : json) without_wall_time(item);
}

// Of a file's bytes; of a result in JSON without its wall times.
inline std::string fingerprint(const std::string& bytes) {
  auto json = json_or_discarded<nlohmann::ordered_json>(bytes);
  if (!json.is_object() || !json.contains("seconds")) return sha256(bytes);
  without_wall_time(json);
  return sha256(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

}  // namespace servodx
