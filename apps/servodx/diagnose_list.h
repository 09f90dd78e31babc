// `servodx diagnose --list FILE --out DIR`: logs by the thousand, one read at a time, one result a log.
#pragma once
#include <string>

#include "invocation.h"

namespace servodx {

struct ListOptions {
  std::string list, out, chunk = "1/1";
  bool exit_code = false;       // end with 10 for a fault, 11 for unknown
  std::string actions;          // file of actions by label; empty: the program's
  bool explain_unknown = true;  // ask what stands first where no fault explains a log
  bool pages = false;           // a page a log beside its result
};

// The exit code.
int diagnose_list(const CommonOptions& common, const RunOptions& run, const ListOptions& options,
                  const std::string& params, const std::string& baseline);

}  // namespace servodx
