// The visible list of effects: missing physics, one file and one line each.
#pragma once
#include <string>
#include <vector>

#include "effects/effect.h"
#include "effects/magnetic_hysteresis.h"
#include "effects/mount_compliance.h"
#include "model/hooks.h"

namespace servodx {

using NoEffects = EffectList<>;
using AllEffects = EffectList<MagneticHysteresis,  //
                              MountCompliance>;
inline constexpr int n_values = n_parameters + AllEffects::n_parameters;  // length of a parameter vector

struct EffectInfo {
  std::string name, place, meaning;
  int first = 0;  // position of its first parameter in a parameter vector
  std::vector<EffectParameter> parameters;
};
const std::vector<EffectInfo>& effect_list();

}  // namespace servodx
