// `servodx check --list FILE`: checks by the thousand, one log at a time, each recorded in its valve's history.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "invocation.h"
#include "report/shared/json.h"
#include "servodx/trend.h"

namespace servodx {

struct CheckListOptions {
  std::string list, out;        // out: folder of the results, one JSON a check; empty: none
  std::string params, history;  // params: of the rows that name no table; may be empty
  CheckOptions check;
};

// The exit code.
int check_list(const CommonOptions& common, const CheckListOptions& options);

// What a valve's history says ahead of a check: where its fit may start, and a serial number that has changed.
struct Before {
  std::vector<double> last;
  std::vector<std::string> notices;
};
Before before_check(const std::optional<History>& history, const std::string& valve, const std::string& serial);

report::Json check_settings(const std::string& valve, double at, const std::string& model, const std::string& history);

}  // namespace servodx
