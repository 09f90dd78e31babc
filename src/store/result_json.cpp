#include "store/result_json.h"

#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/reading_limits.h"
#include "servodx/error.h"

namespace servodx::store {
namespace {

using Json = nlohmann::ordered_json;

bool is_result(const Json& json) {
  const auto tool = json.is_object() ? json.find("tool") : json.end();
  return json.is_object() && json.contains("command") && tool != json.end() && *tool == "servodx";
}

}  // namespace

Json read_result(const std::string& path) {
  Json json = json_or_discarded<Json>(read_file_within(path, largest_json));
  if (!is_result(json))
    throw InputError({path, 0, ""}, "is no result of servodx", "name a file that --json wrote, or a baseline");
  return json;
}

}  // namespace servodx::store
