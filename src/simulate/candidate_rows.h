// The rows of a pack of candidates, and the numbers that follow from them, as the log has them: what was measured takes
// the place of the row or effect that stands for it, and a test stand that of the actuator. Fixed for the whole run.
// Lanes without a candidate repeat the first.
// Left out: tubes and blanking plates of a stand that give way. Source: docs/model.md, "On a test stand".
#pragma once
#include <array>

#include "base/pack.h"
#include "effects/registry.h"
#include "effects/return_drop.h"
#include "effects/supply_droop.h"
#include "model/derived.h"
#include "parameters/list.h"
#include "servodx/rig.h"
#include "simulate/nuisance.h"
#include "simulate/scenario.h"

namespace servodx {

// Ports joined by a tube: wide enough to drop 0.02 bar at 10 l/min. [m3/s/Pa]
inline constexpr double tube_conductance = 1e-7;

template <class T>
std::array<T, n_candidate> candidate_rows(const Scenario& in, const ParameterVector* const* candidates, int lanes) {
  std::array<T, n_candidate> p;
  for (int k = 0; k < n_candidate; ++k)
    for (int lane = 0; lane < Lanes<T>::count; ++lane)
      Lanes<T>::set(p[k], lane, (*candidates[lane < lanes ? lane : 0])[k]);
  if (in.command_slope) p[nuisance::command_slope] = T(*in.command_slope);
  if (in.current_measured) p[row::driver_bandwidth] = T(2e4);               // the amplifier is behind us
  if (!in.supply_pressure.empty()) p[effect_row<SupplyDroop>(0)] = T(0.0);  // what is measured holds the droop
  if (!in.return_pressure.empty()) p[effect_row<ReturnDrop>(0)] = T(0.0);
  // On a test stand the piston is held and displaces nothing, and a tube takes the place of the seal's leakage.
  if (in.ports != Ports::actuator) p[row::piston_area_a] = p[row::piston_area_b] = T(0.0);
  return p;
}

// p: rows as above.
template <class T, class Effects>
Derived<T> derived_numbers(const Scenario& in, const T* p) {
  Derived<T> d = derive<T, Effects>(p, in.oil);
  if (in.ports != Ports::actuator) {
    d.leak = T(in.ports == Ports::free ? tube_conductance : 0.0);
    // A port that empties within a step overshoots return; free air would expand there and hold it below.
    d.air = T(0.0);
  }
  return d;
}

template <class T>
bool any_breakaway(const T* p) {
  for (int lane = 0; lane < Lanes<T>::count; ++lane)
    if (Lanes<T>::get(p[row::piston_stribeck_friction], lane) != 0.0) return true;
  return false;
}

}  // namespace servodx
