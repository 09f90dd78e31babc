#include "fleet/result_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "base/json_text.h"
#include "base/reading_limits.h"
#include "base/sha256.h"

namespace servodx {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

bool is_text(const Json& object, const char* key, const std::string& wanted) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() && found->get_ref<const std::string&>() == wanted;
}

std::vector<std::string> hashes_of(const Json& result) {
  std::vector<std::string> hashes;
  const auto inputs = result.find("inputs");
  if (inputs == result.end() || !inputs->is_array()) return hashes;
  for (const Json& input : *inputs)
    if (input.is_object() && input.contains("sha256") && input["sha256"].is_string())
      hashes.push_back(input["sha256"].get<std::string>());
  return hashes;
}

bool rests_on(const Json& result, const ResultBasis& basis) {
  if (!is_text(result, "command", "diagnose")) return false;
  if (!is_text(result, "version", basis.version) || !is_text(result, "commit", basis.commit)) return false;
  const auto settings = result.find("settings");
  if (settings == result.end() || *settings != json_or_discarded<Json>(basis.settings)) return false;
  const auto seed = result.find("seed");
  if (seed == result.end() || !seed->is_number_unsigned() || seed->get<std::uint64_t>() != basis.seed) return false;
  std::vector<std::string> there = hashes_of(result), wanted = basis.inputs;
  std::sort(there.begin(), there.end());
  std::sort(wanted.begin(), wanted.end());
  return there == wanted;
}

FleetVerdict verdict_of(const Json& result) {
  const auto results = result.find("results");
  if (results == result.end() || !results->is_array() || results->size() != 1 || !results->front().is_object())
    return FleetVerdict::none;
  const auto verdict = results->front().find("verdict");
  if (verdict == results->front().end() || !verdict->is_string()) return FleetVerdict::none;
  return verdict_named(verdict->get<std::string>());
}

}  // namespace

std::string result_name(const std::string& log, const std::string& use) {
  constexpr std::size_t longest_stem = 100;  // characters: with hash and ending far below the 255 of a file name
  constexpr std::size_t hash_digits = 16;    // two of a million paths share them with a chance of 3e-8
  const fs::path path = fs::path(log).lexically_normal();
  std::string name = path.stem().string().substr(0, longest_stem);
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  const std::string hashed = path.generic_string() + (use.empty() ? "" : "\n" + use);
  return name + "." + sha256(hashed).substr(0, hash_digits);
}

FleetVerdict standing_verdict(const std::string& result_path, const ResultBasis& basis) {
  std::error_code ignored;
  if (!fs::is_regular_file(result_path, ignored)) return FleetVerdict::none;
  const Json result = json_or_discarded<Json>(read_file_within(result_path, largest_json));
  return result.is_object() && rests_on(result, basis) ? verdict_of(result) : FleetVerdict::none;
}

}  // namespace servodx
