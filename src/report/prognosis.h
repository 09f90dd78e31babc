// Results of `monitor`, `check` and `trend` as JSON and as text.
#pragma once
#include <string>

#include "prognose/check.h"
#include "report/json.h"

namespace servodx::report {

Json to_json(const Check& check, double temperature);
Json check_json(const CheckResult& result);
std::string text_of(const CheckResult& result);

}  // namespace servodx::report
