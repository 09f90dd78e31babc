// What is supposed of a check's growth before its points are read: scale, noise, what temperature and oil may do.
//
// From the first checks, the way to failure and the fault's own severity. The numbers are wide on purpose: they say
// what would be odd, not what is expected. Limits: one set for all valves of a type, but for what a seeded-fault test
// taught.
#pragma once
#include <cstddef>

#include "prognose/check_series.h"
#include "prognose/growth.h"

namespace servodx {

GrowthPrior prior_of(const CheckSeries& series, std::size_t healthy, const FailureAt& failure);

}  // namespace servodx
