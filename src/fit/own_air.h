// How far a fit seeks the free air of a log's oil.
#pragma once

namespace servodx {

// At atmospheric pressure. By the same measure an oil holds some 9 % in solution (Bunsen's coefficient 0.09). [-]
inline constexpr double least_own_air = 2e-4, most_own_air = 0.08;

}  // namespace servodx
