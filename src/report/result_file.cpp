#include "report/result_file.h"

#include <fmt/format.h>

#include "base/csv.h"
#include "base/json_text.h"
#include "servodx/error.h"

namespace servodx::report {
namespace {

bool is_result(const Json& json) {
  const auto tool = json.is_object() ? json.find("tool") : json.end();
  return json.is_object() && json.contains("command") && tool != json.end() && *tool == "servodx";
}

}  // namespace

Json read_result(const std::string& path) {
  Json json = json_or_discarded<Json>(read_file(path));
  if (!is_result(json))
    throw InputError({path, 0, ""}, "is no result of servodx", "name a file that --json wrote, or a baseline");
  return json;
}

bool holds_one_verdict(const Json& result) {
  const auto verdicts = result.find("results");
  return text_or_empty(result, "command") == "diagnose" && verdicts != result.end() && verdicts->is_array() &&
         verdicts->size() == 1 && verdicts->front().is_object();
}

Json read_one_verdict(const std::string& path) {
  Json json = read_result(path);
  if (!holds_one_verdict(json))
    throw InputError(
        {path, 0, "results"},
        text_or_empty(json, "command") == "diagnose" ? "holds not one verdict" : "is no result of 'diagnose'",
        "name what 'diagnose LOG --json FILE' wrote of one log, or of a pool");
  return json;
}

}  // namespace servodx::report
