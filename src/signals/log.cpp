#include "signals/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/sha256.h"
#include "base/small_letters.h"
#include "servodx/rig.h"
#include "signals/log_formats.h"

namespace servodx {

bool is_mat_file(const std::string& path) {
  return in_small_letters(path.substr(path.size() - std::min<std::size_t>(4, path.size()))) == ".mat";
}

void ReadOptions::validate() const {
  constexpr std::size_t fewest = 2;  // a step between samples
  if (minimum_rows < fewest)
    throw InputError({.file = "ReadOptions.minimum_rows"}, fmt::format("{} rows are no log", minimum_rows),
                     fmt::format("ask for {} or more; {} is the default", fewest, ReadOptions{}.minimum_rows));
}

Log read_log(const std::string& path, const RigFile& rig, const ReadOptions& options) {
  options.validate();
  return is_mat_file(path) ? read_mat_log(path, rig, options) : read_csv_log(path, rig, options);
}

std::string content_hash(const Log& log) {
  Sha256 hash;
  const auto add = [&](std::string_view name, const std::vector<double>& values) {
    hash.add(name);
    for (double v : values) {
      if (v == 0) v = 0;                                                // one zero
      if (std::isnan(v)) v = std::numeric_limits<double>::quiet_NaN();  // one NaN
      hash.add({reinterpret_cast<const char*>(&v), sizeof v});
    }
  };
  add(name_of(Signal::time), log.time);
  for (int s = 0; s < n_signals; ++s)
    if (const auto signal = static_cast<Signal>(s); log.has(signal)) add(name_of(signal), log[signal]);
  return hash.hex();
}

}  // namespace servodx
