// Checks that the options of several calls share.
#pragma once
#include <fmt/format.h>

#include <string>

#include "servodx/error.h"

namespace servodx::door {

inline void require_setting(bool holds, const std::string& option, const std::string& rule, const std::string& mend) {
  if (!holds) throw InputError({option, 0, ""}, rule, mend);
}

inline void require_threads(int threads) {
  require_setting(threads >= 0, "--threads", fmt::format("{} threads cannot run", threads),
                  "give 0 for all cores, or how many");
}

}  // namespace servodx::door
