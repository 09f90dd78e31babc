// A planned test as text, JSON and a page.
#pragma once
#include <string>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/plan.h"

namespace servodx::report {

std::string text_of(const PlannedTest& test, const std::string& written_to);
Json plan_json(const PlannedTest& test);
Page plan_page(const Header& header, const PlannedTest& test);

}  // namespace servodx::report
