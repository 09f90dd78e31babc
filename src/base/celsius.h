// The Celsius scale's zero, and the oil's temperature of reference on it.
#pragma once

namespace servodx {

inline constexpr double zero_celsius = 273.15;  // [K]
// 40 degC: viscosity grades are stated there (ISO 3448), a table's values hold there, and oil of which nothing is said
// is taken to be there.
inline constexpr double reference_oil_temperature = 313.15;  // [K]

}  // namespace servodx
