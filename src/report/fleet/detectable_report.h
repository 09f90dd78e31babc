// The least that logs would have shown of a fault, beside what was found, in words, JSON and on a page.
#pragma once
#include <string>

#include "fleet/detectable_found.h"
#include "report/shared/json.h"
#include "report/shared/page.h"

namespace servodx::report {

std::string text_of(const DetectableFound& found);  // empty where no size is known
Json to_json(const DetectableFound& found);
void add_detectable_found(Page& page, const DetectableFound& found);

}  // namespace servodx::report
