// The manifest beside a result: what was called, on what, and the fingerprints of what came of it.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace servodx {

inline constexpr const char* manifest_suffix = ".manifest.json";

// Takes out, at any depth, what measures this machine's time: the one thing that two runs do not share.
void without_wall_time(nlohmann::ordered_json& json);

// Of a file's bytes; of a result in JSON without its wall times.
std::string fingerprint(const std::string& bytes);

// Files that the call of a manifest read, as seen from here. Empty where there is no manifest, or it is none.
std::vector<std::string> inputs_of_manifest(const std::string& path);

}  // namespace servodx
