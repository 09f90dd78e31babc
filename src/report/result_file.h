// Results of the program, read back as JSON: for `compare`, and for a verdict that is set beside the last one.
#pragma once
#include <string>

#include "report/json.h"

namespace servodx::report {

// Throws InputError where the file is no result that --json wrote, nor a baseline.
Json read_result(const std::string& path);

// Of `diagnose`, with one verdict.
bool holds_one_verdict(const Json& result);
Json read_one_verdict(const std::string& path);  // throws InputError where it does not

}  // namespace servodx::report
