// Results of `monitor`, `check` and `trend` as JSON and as text.
#pragma once
#include <string>

#include "prognose/check.h"
#include "prognose/trend.h"
#include "report/json.h"

namespace servodx::report {

Json to_json(const Check& check, double temperature);
Json check_json(const CheckResult& result);
std::string text_of(const CheckResult& result);

Json to_json(const ValveTrend& trend);
// One valve's keys at the top; of several, an array `valves`, the first to reach its warning level first.
Json trend_json(const std::vector<ValveTrend>& trends, bool all);
std::string text_of(const ValveTrend& trend);
std::string ranking(const std::vector<ValveTrend>& trends);

}  // namespace servodx::report
