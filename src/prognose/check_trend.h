// The trend of one check: the recipe from its points to levels, state and life. Its steps stand in files of their own.
#pragma once
#include <cstddef>

#include "prognose/check_series.h"
#include "prognose/trend.h"
#include "prognose/trend_options.h"

namespace servodx {

// `names`: checks of the valve, among which the rate of false alarms is shared.
CheckTrend trend_of(const CheckSeries& series, const TrendSettings& options, std::size_t names);

}  // namespace servodx
