// How far the piston's seals yield before they slip. The base model takes an elastomer's families of asperities; a slip
// ring of PTFE, a lapped piston or piston rings slip after a tenth of that way, a soft lip after several times (Iwan
// 1966; Al-Bender, Lampaert & Swevers 2005). It decides how a stopped piston rings on its oil, and what its pressures
// keep of the friction after it. Nothing else of friction changes.
#pragma once
#include "effects/effect.h"

namespace servodx {

struct SealYield {
  static constexpr const char* name = "seal_yield";
  static constexpr const char* place = "piston_force";
  static constexpr const char* meaning = "the piston's seals yield more, or less, before they slip";
  static constexpr Freed freed = Freed::on_actuators;
  static constexpr bool as_made = true;  // of the seals, and alike in all logs
  static constexpr bool of_construction = true;
  static constexpr const char* best_test = "steps that end in a closed valve";
  static constexpr int n_states = 0;
  static constexpr int n_parameters = 1;
  static constexpr EffectParameter parameters[n_parameters] = {
      {"seal_yield", "-", 1.0, 0.05, 3.0, 0.4,
       "way over which the seals yield before they slip, over the usual seal's"},
  };
  // [-] added to the base model's; q: own parameters.
  template <class T>
  static T seal_yield(const T* q) {
    return q[0] - T(parameters[0].off);
  }
};

}  // namespace servodx
