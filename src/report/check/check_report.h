// The result of `check` as JSON, text and page.
#pragma once
#include <string>
#include <vector>

#include "prognose/check.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {

Json to_json(const Check& check, double temperature);
Json check_json(const CheckResult& result);
std::string text_of(const CheckResult& result);
// The running |e|, where the log is long enough for it, and every check with its correction.
Page check_page(const Header& header, const CheckResult& result, const std::vector<double>& time);

}  // namespace servodx::report
