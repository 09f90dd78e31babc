// The logs that tuned a table, where its manifest says they lie and they are as they were.
#pragma once
#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/csv.h"
#include "base/sha256.h"
#include "manifest.h"
#include "servodx/table.h"
#include "servodx/tuned_by.h"

namespace servodx {

inline std::vector<std::string> tuning_logs(const std::string& params, const Table& table) {
  const std::vector<TunedBy> tuning = tuned_by(table);
  std::vector<std::string> out;
  std::error_code absent;
  for (const std::string& path : inputs_of_manifest(params + manifest_suffix)) {
    if (!std::filesystem::is_regular_file(path, absent)) continue;
    const std::string hash = sha256(read_file(path));
    if (std::any_of(tuning.begin(), tuning.end(), [&](const TunedBy& by) { return by.sha256 == hash; }))
      out.push_back(path);
  }
  return out;
}

}  // namespace servodx
