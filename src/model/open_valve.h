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
// Of a valve of 14 l/min at 207 bar, and the worst leak beside it: more than the valve passes, so that the cylinder
// holds no load. [m3/s/Pa]
inline constexpr double usual_conductance = 1.32e-11, usual_worst_leak = 2e-11;
inline double times_usual_valve(const double* v) { return conductance_of_valve(v) / usual_conductance; }
inline double worst_leak(const double* v) { return usual_worst_leak * times_usual_valve(v); }

}  // namespace servodx
