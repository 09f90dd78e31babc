// What the open valve passes: beside it a leak of the cylinder is small or large.
#pragma once
#include <cmath>

#include "model/constants.h"
#include "parameters/list.h"

namespace servodx {

// Flow of one edge at the spool's stop under the supply pressure, over that pressure [m3/s/Pa]; v: rows.
inline double conductance_of_valve(const double* v) {
  constexpr double density = 860;  // [kg/m3] mineral oils differ by 3 %
  return constants::cd_metering * v[row::port_width] * v[row::spool_stop] /
         std::sqrt(density * v[row::supply_pressure]);
}
// A seal that passes more than the valve does: the cylinder holds no load. [m3/s/Pa]
inline double worst_leak(const double* v) { return 1.5 * conductance_of_valve(v); }

}  // namespace servodx
