#include "store/truth_file.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "base/json_text.h"
#include "base/key_error.h"

namespace servodx::store {

std::string truth_beside(const std::string& log, const std::string& sha256) {
  const std::string path = log.substr(0, log.rfind('.')) + ".truth.json";
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return "";
  constexpr const char* mend = "it stands beside a log of that name: mend it or move it away";
  const auto truth = json_in_file<nlohmann::ordered_json>(path, mend);
  const auto text = [&](const char* key) -> std::string {
    if (!truth.is_object() || !truth.contains(key)) return "";
    if (!truth[key].is_string()) throw key_error({path, 0, key}, "is not a text", mend);
    return truth[key].get<std::string>();
  };
  return text("sha256") == sha256 ? text("label") : "";
}

}  // namespace servodx::store
