#include "store/result_json.h"

#include <nlohmann/json.hpp>

#include "base/json_text.h"
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
  constexpr const char* name_another = "name a file that --json wrote, or a baseline";
  Json json = json_in_file<Json>(path, name_another);
  if (!is_result(json)) throw InputError({path, 0, ""}, "is no result of servodx", name_another);
  return json;
}

}  // namespace servodx::store
