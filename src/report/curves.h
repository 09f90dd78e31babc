// The acceptance sheet of `servodx curves` as text, JSON and a picture.
#pragma once
#include <string>

#include "curves/curves.h"
#include "report/json.h"

namespace servodx::report {

std::string text_of(const curves::Sheet& sheet, const std::string& log, bool colour);
Json curves_json(const curves::Sheet& sheet);
std::string curves_svg(const curves::Sheet& sheet, double rated_current);

}  // namespace servodx::report
