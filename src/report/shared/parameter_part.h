// Rows of results that moved, as a part of a page.
#pragma once
#include <string>
#include <vector>

#include "report/shared/parts.h"
#include "servodx/tune.h"
#include "tune/tune.h"

namespace servodx::report {

// The rows that moved, farthest first: by their standard errors where these are known, then by their size.
Moves moves_of(const std::vector<ParameterResult>& parameters, const std::string& title);

}  // namespace servodx::report
