// Results of `monitor`, `check` and `trend` as JSON, text and pages.
#pragma once
#include <string>

#include "prognose/check.h"
#include "prognose/trend.h"
#include "report/json.h"
#include "report/page.h"

namespace servodx::report {

Json to_json(const Check& check, double temperature);
Json check_json(const CheckResult& result);
std::string text_of(const CheckResult& result);

Json to_json(const ValveTrend& trend);
// One valve's keys at the top; of several, an array `valves`, the first to reach its warning level first.
Json trend_json(const std::vector<ValveTrend>& trends, bool all);
std::string text_of(const ValveTrend& trend);
std::string ranking(const std::vector<ValveTrend>& trends);

// The running |e|, where the log is long enough for it, and every check with its correction.
Page check_page(const Header& header, const CheckResult& result, const std::vector<double>& time);
// One valve: each check over its hours with levels, and how long is left; of several, the ranking first.
Page trend_page(const Header& header, const std::vector<ValveTrend>& trends, bool all);

}  // namespace servodx::report
