// What stands in for nothing where a logarithm or a quotient is taken: below any figure of this program, above what
// doubles hold as denormal.
#pragma once

namespace servodx {

inline constexpr double tiny = 1e-300;

}  // namespace servodx
