// Checks that the options of several calls share. `option`: its real name, which stands where a file's name would.
#pragma once
#include <fmt/format.h>

#include <string>

#include "base/error.h"

namespace servodx {

inline void require_setting(bool holds, const std::string& option, const std::string& rule, const std::string& mend) {
  if (!holds) throw InputError({.file = option}, rule, mend);
}

inline void require_threads(int threads, const std::string& option = "--threads") {
  require_setting(threads >= 0, option, fmt::format("{} threads cannot run", threads),
                  "give 0 for all cores, or how many");
}

}  // namespace servodx
