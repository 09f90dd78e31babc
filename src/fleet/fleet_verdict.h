// The verdict on one log as its result file says it.
#pragma once
#include <string>

namespace servodx {

enum class FleetVerdict { none, healthy, fault, unknown };

// none: the word is no verdict.
FleetVerdict verdict_named(const std::string& word);
const char* word_of(FleetVerdict verdict);

}  // namespace servodx
