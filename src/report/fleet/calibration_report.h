// Stated probabilities beside how often the names were right, in words, JSON and on a page.
#pragma once
#include <string>

#include "fleet/calibration.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {

std::string text_of(const Calibration& calibration);  // empty where nothing was stated
Json to_json(const Calibration& calibration);
void add_calibration(Page& page, const Calibration& calibration);

}  // namespace servodx::report
