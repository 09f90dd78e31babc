// The oil of a rig file at a temperature.
#pragma once
#include "model/state.h"
#include "servodx/rig.h"

namespace servodx {

// kelvin: [K]
inline Oil oil_of(const Fluid& fluid, double kelvin) {
  return oil_at(fluid.density, fluid.kinematic_viscosity, kelvin, fluid.kinematic_viscosity_100);
}

}  // namespace servodx
