// The result of `trend` as JSON, text and page.
#pragma once
#include <string>
#include <vector>

#include "prognose/trend.h"
#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/trend.h"

namespace servodx::report {

Json to_json(const ValveTrend& trend);
// One valve's keys at the top; of several, an array `valves`, the first to reach its warning level first.
Json trend_json(const std::vector<Trend>& trends, bool all);
std::string text_of(const ValveTrend& trend);
std::string ranking(const std::vector<Trend>& trends);

// One valve: each check over its hours with levels, and how long is left; of several, the ranking first.
Page trend_page(const Header& header, const std::vector<ValveTrend>& trends, bool all);
Page trend_page(const Header& header, const std::vector<Trend>& trends, bool all);

}  // namespace servodx::report
