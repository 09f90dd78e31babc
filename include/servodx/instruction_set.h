// What simulations are computed with here: results of two instruction sets differ in the last digits.
#pragma once
#include <string>

namespace servodx {

// "avx512", "avx2" or "generic": the widest that this processor has, or what the environment's SERVODX_INSTRUCTION_SET
// asks for. Throws InputError where the processor lacks that.
std::string instruction_set();

}  // namespace servodx
