// Where a check has failed, in the coordinate of its growth, and how well that level is known.
//
// The user's level counts first, then a current or a multiple, then the fault's own (the end of Borello's range). A
// severity that multiplies does so to the tuned value. The paper's checks have none but a user's.
#pragma once
#include "prognose/check_series.h"
#include "prognose/growth.h"
#include "prognose/trend_options.h"

namespace servodx {

FailureAt own_failure(const CheckSeries& series);
FailureAt failure_of(const CheckSeries& series, const TrendSettings& options);

}  // namespace servodx
