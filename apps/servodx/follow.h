// `servodx watch --follow FILE` and `servodx watch -`: a log that grows, watched sample by sample.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "invocation.h"

namespace servodx {

struct FollowOptions {
  std::string source;  // a file, or "-"
  std::string params, baseline;
  std::vector<std::string> healthy;  // logs that the limits rest on; empty: the baseline's
  double alarms_per_hour = 0.1;
  std::string state, events;  // files; empty: none. events "-": standard output
  double until_idle = 0;      // [s] 0: never
  bool exit_code = false;
};

int follow(const FollowOptions& options, const CommonOptions& common);

}  // namespace servodx
