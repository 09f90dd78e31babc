// What simulations are computed with here: results of two instruction sets differ in the last digits.
#pragma once
#include <string>

namespace servodx {

std::string instruction_set();  // "avx512", "avx2" or "generic", of this processor

}  // namespace servodx
