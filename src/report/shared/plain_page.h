// The page of a command that has none of its own: its words, then every list of its result as a table.
#pragma once
#include <string>
#include <vector>

#include "fit/log_data.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/log.h"

namespace servodx::report {

Page plain_page(const Header& header, const std::string& text, const Json& body);

// Columns of a log over time, for what writes logs.
Page columns_page(const Header& header, const std::string& headline, const std::vector<OutputColumn>& columns);

}  // namespace servodx::report
