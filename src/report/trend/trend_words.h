// What text, JSON and page of a trend say in the same words.
#pragma once
#include <string>

#include "prognose/trend_state.h"

namespace servodx::report {

const char* word_of(TrendState state);
std::string in_hours(double hours);  // "120 h", "never"

}  // namespace servodx::report
