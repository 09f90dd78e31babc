// The visible list of effects: missing physics, one file and one line each.
#pragma once
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mount_compliance.h"
#include "effects/nozzle_plugging.h"
#include "effects/stiction.h"
#include "model/hooks.h"

namespace servodx {

using NoEffects = EffectList<>;
using AllEffects = EffectList<MagneticHysteresis,  //
                              MountCompliance,     //
                              NozzlePlugging,      //
                              Stiction>;
inline constexpr int n_values = n_parameters + AllEffects::n_parameters;  // length of a parameter vector

struct EffectInfo {
  std::string name, place, meaning;
  int first = 0;  // position of its first parameter in a parameter vector
  std::vector<EffectParameter> parameters;
};
const std::vector<EffectInfo>& effect_list();

// Position of effect E's j-th parameter in a parameter vector.
template <class E>
constexpr int effect_row(int j) {
  return n_parameters + AllEffects::parameter_offset<E>() + j;
}

}  // namespace servodx
