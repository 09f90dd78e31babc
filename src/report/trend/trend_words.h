// What text, JSON and page of a trend say in the same words.
#pragma once
#include "prognose/trend_state.h"

namespace servodx::report {

const char* word_of(TrendState state);

}  // namespace servodx::report
