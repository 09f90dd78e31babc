// The input that shows a cause best, in words.
#pragma once
#include <string>

namespace servodx {

// Empty where none stands out, as for a bare row.
std::string best_test_of(const std::string& effect);

}  // namespace servodx
