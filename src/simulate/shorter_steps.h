// Which candidates of a pack must take a sample in shorter steps than its log asks for: each function gives a number
// that is not below 0 where it must (is_due), lane by lane, without a branch.
//
// A rod that comes upon its stop is seen a sample before: that candidate takes the sample in short steps too, or is
// thrown back at many times its speed, or not, by the last digit of its values. So does one whose flapper lies on a
// nozzle. One that is lost goes back and takes it in steps eight and 64 times as short.
// Limits: a rod that gets its speed only after the sample began is not foreseen. Source:
// docs/model.md, "Nozzles" and "End stops" under "Integration", with what was measured.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

#include "base/pack.h"
#include "model/constants.h"
#include "model/derived.h"
#include "model/state.h"
#include "parameters/list.h"

namespace servodx {

template <class T>
bool is_due(const T& due, int lane) {
  return !(Lanes<T>::get(due, lane) < 0.0);
}

// Far beyond its stops, or at pressures that oil does not know, a lane has diverged: not below 1.
template <class T, std::size_t n>
T excess(const std::array<T, n>& y, const T* p) {
  const T per_travel = T(0.1) / p[row::spool_stop];
  const T per_pressure = T(1e-9), x = y[s_x_spool] * per_travel, rod = y[s_x_piston] * T(1e-3),
          p_1 = y[s_p_pilot_1] * per_pressure, p_2 = y[s_p_pilot_2] * per_pressure, p_a = y[s_p_a] * per_pressure,
          p_b = y[s_p_b] * per_pressure;
  return (x * x + rod * rod) + (p_1 * p_1 + p_2 * p_2) + (p_a * p_a + p_b * p_b);
}
template <class T, std::size_t n>
T lost(const std::array<T, n>& y, const T* p) {
  return excess(y, p) - T(1.0);
}

// Whose rod would be in a stop after `dt` at its speed, and further in than now by more than the face is rough.
template <class T, std::size_t n>
T impacts(const std::array<T, n>& y, const Derived<T>& d, double dt) {
  const T rough = T(constants::piston_stop_rounding), deep = d.half_stroke + rough;
  const T here = y[s_x_piston], there = here + y[s_v_piston] * T(dt);
  using std::min;
  return min(there * there - deep * deep, there * there - here * here - T(2.0) * d.half_stroke * rough);
}

// Whose flapper lies on a nozzle. The spool slews then, for as long as filter and oil let it, and how the flapper
// leaves is settled within a tenth of a millisecond: by longer steps the spool arrives anywhere.
template <class T, std::size_t n>
T on_nozzle(const std::array<T, n>& y, const T* p) {
  return y[s_x_flapper] * y[s_x_flapper] - p[row::nozzle_gap] * p[row::nozzle_gap];
}

}  // namespace servodx
