// An oil thickens under pressure: by Barus' law its viscosity grows by exp(alpha p), with alpha of 1.5e-8 to 2.5e-8
// 1/Pa for hydraulic oils (Barus 1893; ASME Pressure-Viscosity Report 1953). At 207 bar that is a third to two thirds.
// So where the edges' flow is laminar, at small openings and in the cold, those from supply pass less than those to
// return.
//
// Acts on the metering edges, at the mean pressure of each. Elsewhere the pressure hardly moves, and what it adds to
// the viscosity is part of what a tune finds.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct PressureViscosity {
  static constexpr const char* name = "pressure_viscosity";
  static constexpr const char* place = "metering";
  static constexpr const char* meaning = "the oil thickens under pressure";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool as_made = true;  // of the oil, and alike in all logs
  static constexpr bool of_construction = true;
  static constexpr const char* best_test =
      "small motion in cold oil: both chambers rest at less pressure than in warm oil";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"viscosity_rise", "1/Pa", 0.0, 0.0, 4e-8, 2e-8, "relative rise of the oil's viscosity with pressure"},
  };
  // [1/Pa] q: own parameters.
  template <class T>
  static T viscosity_rise(const T* q) {
    return q[0];
  }
};

}  // namespace servodx
