// The sensitivity table for people and for programs: text, a tornado plot, JSON.
#pragma once
#include <string>

#include "report/shared/json.h"
#include "report/shared/page.h"
#include "servodx/sensitivity.h"

namespace servodx::report {

std::string text_of(const Sensitivity& sensitivity);
Json sensitivity_json(const Sensitivity& sensitivity);
Page sensitivity_page(const Header& header, const Sensitivity& sensitivity);

}  // namespace servodx::report
