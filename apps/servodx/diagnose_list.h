// `servodx diagnose --list FILE --out DIR`: logs by the thousand, one read at a time, one result a log.
#pragma once
#include <string>

#include "invocation.h"

namespace servodx {

struct ListOptions {
  std::string list, out, chunk = "1/1";
};

// The exit code.
int diagnose_list(const CommonOptions& common, const ListOptions& options, const std::string& params,
                  const std::string& baseline, bool exit_code);

}  // namespace servodx
