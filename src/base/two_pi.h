// A whole turn.
#pragma once
#include <numbers>

namespace servodx {

inline constexpr double two_pi = 2 * std::numbers::pi;  // [rad]

}  // namespace servodx
