// The Bode plot of a valve beside the valve as it was tuned, and where each has its bandwidth.
#pragma once
#include <vector>

#include "report/shared/page.h"
#include "servodx/bode.h"

namespace servodx::report {

void add_bode(Page& page, const std::vector<Bode>& bodes);

}  // namespace servodx::report
