// Quantiles of the normal distribution, to the digits that a report states.
#pragma once

namespace servodx {

inline constexpr double normal_95_one_sided = 1.645;  // [standard deviations] one in twenty lies above; 90 % within
inline constexpr double normal_95 = 1.96;             // 95 % lie within

}  // namespace servodx
