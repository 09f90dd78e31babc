// The Celsius scale's zero.
#pragma once

namespace servodx {

inline constexpr double zero_celsius = 273.15;  // [K]

}  // namespace servodx
