#include "read_manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/json_text.h"

namespace servodx {
namespace {

bool has_the_types(const report::Json& m) {
  const auto is_text = [](const report::Json& j) { return j.is_string(); };
  const auto is_file = [](const report::Json& j) {
    return j.is_object() && j.contains("path") && j["path"].is_string() && j.contains("sha256") &&
           j["sha256"].is_string();
  };
  const auto all = [](const report::Json& list, const auto& holds) {
    return list.is_array() && std::all_of(list.begin(), list.end(), holds);
  };
  return all(m["arguments"], is_text) && all(m["inputs"], is_file) && all(m["outputs"], is_file) &&
         m["command"].is_string() && m["directory"].is_string() && m["version"].is_string() &&
         m["interrupted"].is_boolean();
}

}  // namespace

report::Json read_manifest(const std::string& path) {
  constexpr const char* mend = "name the file FILE.manifest.json beside a result of servodx";
  const auto m = json_in_file<report::Json>(path, mend);
  const auto refuse = [&](const std::string& rule) { throw InputError({path, 0, ""}, rule, mend); };
  if (!m.is_object() || !m.contains("manifest")) refuse("is no manifest");
  for (const char* key : {"command", "directory", "arguments", "inputs", "outputs", "version", "interrupted"})
    if (!m.contains(key)) refuse(fmt::format("has no '{}'", key));
  if (!has_the_types(m)) refuse("is not as servodx writes it");
  if (m["interrupted"].get<bool>())
    throw InputError({path, 0, "interrupted"}, "that run was interrupted, and where cannot be repeated",
                     "make the result again with its command");
  return m;
}

}  // namespace servodx
