// `selftest` for a person, for a program, and as a page.
#pragma once
#include <string>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/selftest.h"

namespace servodx::report {

std::string text_of(const SelftestResult& result);
Json selftest_json(const SelftestResult& result);
Page selftest_page(const Header& header, const SelftestResult& result);

}  // namespace servodx::report
