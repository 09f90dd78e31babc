// Oils that a rig file may name in place of a [fluid] section: typical new oil of each kind.
//
// 5606, 83282: MIL-PRF-5606 (at least 13.2 mm2/s) and MIL-PRF-83282 (at least 14.0 mm2/s), makers' typical densities.
// AS1241: SAE AS1241 type IV phosphate ester, makers' typical values. ISO VG: ISO 3448 mid-point, typical mineral oil.
#pragma once
#include <string>

#include "servodx/rig.h"

namespace servodx {

// The oil of that name, upper or lower case, with or without blanks and dashes; null: none is called so.
const Fluid* find_oil(const std::string& name);
// "MIL-PRF-5606, MIL-PRF-83282, ..."
std::string names_of_oils();

}  // namespace servodx
